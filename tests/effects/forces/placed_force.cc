// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  /** Of n components, with the variables that these tests need. */
  Expression
  density_of(const std::string &text, const unsigned int n)
  {
    return {"Body force/Force density",
            text,
            n,
            n,
            Vocabulary{{Variable::X,
                        Variable::Y,
                        Variable::Z,
                        Variable::t,
                        Variable::x,
                        Variable::y,
                        Variable::z,
                        Variable::volume}}};
  }


  template <int dim>
  class Field
  {
  public:
    explicit Field(const std::string &text)
      : density(density_of(text, dim))
    {
      std::mt19937 generator(3);
      points = random_points_in_cell<dim>(generator, 4);
      for (unsigned int p = 0; p < 4; ++p)
        {
          typename PlacedForce<dim>::Particle particle;
          particle.volume = 100. + 10. * p;
          for (unsigned int d = 0; d < dim; ++d)
            particle.x[d] = 50. * points.xi[p][d];
          for (double &value : particle.values)
            value = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            particle.values[d] = particle.x[d] - 1.;
          particles.push_back(particle);
        }
      field = random_field<dim>(generator, 0.3);
    }

    PlacedForce<dim>
    term() const
    {
      return {points, particles, density};
    }

    Expression                                       density;
    GroupedPoints<dim>                               points;
    std::vector<typename PlacedForce<dim>::Particle> particles;
    LocalField<dim>                                  field;
  };
} // namespace


TEST(PlacedForce, IsThatOfThePlaceAtTheEnd)
{
  const Field<2> plane("-1e-3*(x - X); 0");
  const auto     forces = plane.term().forces(0, plane.field);
  ASSERT_EQ(forces.size(), 4u);
  for (unsigned int p = 0; p < 4; ++p)
    {
      const SplineValues<2> splines(plane.points.xi[p], plane.points.h);
      const double          u = plane.field.value(splines)[0];
      EXPECT_NEAR(forces[p][0],
                  -1e-3 * plane.particles[p].volume * (u + 1.),
                  1e-12);
      EXPECT_EQ(forces[p][1], 0.);
    }
}


TEST(PlacedForce, OnlyThePresentPlaceAsksForIt)
{
  EXPECT_TRUE(PlacedForce<2>::depends_on_place(density_of("x - X; 0", 2)));
  EXPECT_FALSE(PlacedForce<2>::depends_on_place(density_of("X*t; volume", 2)));
}
