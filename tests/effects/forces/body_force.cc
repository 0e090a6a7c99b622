// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  /** The sum of the forces on all cells of a scene, kPa µm. */
  Tensor<1, 2>
  resultant(const std::vector<std::string> &settings,
            const std::vector<Point<2>>    &positions,
            const double                    t)
  {
    const Alone           alone(settings, positions);
    const SceneEffects<2> effects = effects_of<2>(scene_of(settings));
    EXPECT_EQ(effects.forces.size(), 1u);
    std::mt19937 generator(1);
    const auto   term = effects.forces.at(0).effect->term(
      alone.tissue,
      alone.development.reader(0.),
      random_points_in_cell<2>(generator, positions.size()),
      0.,
      t);
    // Splines sum up to 1, and the residual has the force with a minus.
    const auto residual = TermOnOneCell<2>(*term, GrowthAt::current)
                            .residual(random_field<2>(generator, 0.2));
    Tensor<1, 2>           sum;
    constexpr unsigned int n = BSpline<2>::n;
    for (unsigned int i = 0; i < 2; ++i)
      for (unsigned int a = 0; a < n; ++a)
        sum[i] -= residual[i * n + a];
    return sum;
  }
} // namespace


TEST(BodyForce, IsThatOfTheCellsState)
{
  const std::vector<Point<2>> positions = {{3., 4.}, {53., 4.}};
  const std::vector<double>   V0        = {100., 110.}; // as founders() says
  const auto                  weight    = [&](const unsigned int i) {
    return -1e-3 * V0[i] * V0[i] *
           determinant(some_deformation<2>(positions[i]));
  };
  const auto expect = [&](const std::vector<std::string> &settings,
                          const Tensor<1, 2>             &expected) {
    EXPECT_LT((resultant(settings, positions, 0.5) - expected).norm(),
              1e-13 * expected.norm());
  };
  std::vector<std::string> settings = {
    "Dimension=2", "Body force/Force density=0; -1e-3*volume; 0"};
  expect(settings, Tensor<1, 2>({0., weight(0) + weight(1)}));

  // A type has another one, of place and time.
  settings.push_back("Cell types/Names=still, driven");
  settings.push_back("Cell types/driven/Where=X > 50");
  settings.push_back("Cell types/driven/Body force/Force density=X*t; 0");
  const double driving = V0[1] * 53. * 0.5;
  expect(settings, Tensor<1, 2>({driving, weight(0)}));

  // It is there, though cells without a value of their type's have none.
  settings[1] = "Body force/Force density=0; 0; 0";
  expect(settings, Tensor<1, 2>({driving, 0.}));
}


TEST(BodyForce, IsThatOfThePlaceAtTheEnd)
{
  const std::vector<Point<2>>    positions = {{3., 4.}, {53., 4.}};
  const std::vector<double>      V0        = {100., 110.};
  const std::vector<std::string> settings  = {
    "Dimension=2", "Body force/Force density=-1e-3*(x - X); 0"};
  std::mt19937           generator(3);
  const GroupedPoints<2> points = random_points_in_cell<2>(generator, 2);
  const LocalField<2>    field  = random_field<2>(generator, 0.3);
  const Alone            alone(settings, positions);
  const SceneEffects<2>  effects = effects_of<2>(scene_of(settings));
  const auto             term    = effects.forces.at(0).effect->term(
    alone.tissue, alone.development.reader(0.), points, 0., 0.5);
  EXPECT_FALSE(term->is_conservative());
  const auto forces = term->forces(0, field);
  ASSERT_EQ(forces.size(), 2u);
  for (unsigned int p = 0; p < 2; ++p)
    {
      const double u = field.value(SplineValues<2>(points.xi[p], points.h))[0];
      EXPECT_NEAR(forces[p][0], -1e-3 * V0[p] * u, 1e-12);
      EXPECT_EQ(forces[p][1], 0.);
    }
}
