// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"

/** The middles of the sides of a box in a grid cell, and their area vectors
 *  into the box. */
template <int dim>
SweptVolume<dim>
box_in_cell(const Tensor<1, dim> &lower, const Tensor<1, dim> &size)
{
  constexpr double            h = 50.;
  GroupedPoints<dim>          points{{0, 2 * dim}, {}, h};
  std::vector<Tensor<1, dim>> areas;
  double                      volume = 1.;
  for (unsigned int d = 0; d < dim; ++d)
    volume *= size[d];
  for (unsigned int d = 0; d < dim; ++d)
    for (const double side : {0., 1.})
      {
        Point<dim> xi(lower + 0.5 * size);
        xi[d] = lower[d] + side * size[d];
        points.xi.push_back(xi);
        Tensor<1, dim> area;
        area[d] =
          (side == 0. ? 1. : -1.) * volume / size[d] * std::pow(h, dim - 1.);
        areas.push_back(area);
      }
  return {points, areas};
}


TEST_2D_3D(SweptVolume, Derivatives)
{
  std::mt19937                generator(5);
  std::vector<Tensor<1, dim>> areas;
  for (unsigned int p = 0; p < 7; ++p)
    areas.push_back(100. * random_tensor<1, dim>(generator));
  const SweptVolume<dim> gain(random_points_in_cell<dim>(generator, 7), areas);
  for (unsigned int trial = 0; trial < 3; ++trial)
    expect_derivatives(gain, random_field<dim>(generator, 0.5));
}


// The volume of a box becomes det f times as large, wherever it goes.
TEST_2D_3D(SweptVolume, OfABox)
{
  std::mt19937   generator(6);
  Tensor<1, dim> lower, size;
  for (unsigned int d = 0; d < dim; ++d)
    {
      lower[d] = 0.1 + 0.1 * d;
      size[d]  = 0.5 - 0.1 * d;
    }
  const SweptVolume<dim> gain   = box_in_cell<dim>(lower, size);
  double                 volume = 1.;
  for (unsigned int d = 0; d < dim; ++d)
    volume *= 50. * size[d];
  for (unsigned int trial = 0; trial < 5; ++trial)
    {
      const auto               A     = 0.4 * random_tensor<2, dim>(generator);
      const auto               a     = 30. * random_tensor<1, dim>(generator);
      const auto               field = affine_field(a, A, 50.);
      const TermOnOneCell<dim> at(gain, GrowthAt::current);
      EXPECT_NEAR(at.energy(field),
                  (determinant(unit_tensor<dim>() + A) - 1.) * volume,
                  1e-10 * volume);
      // It pushes a closed surface nowhere.
      const auto force = at.residual(field);
      for (unsigned int i = 0; i < dim; ++i)
        {
          double sum = 0.;
          for (unsigned int b = 0; b < BSpline<dim>::n; ++b)
            sum += force[i * BSpline<dim>::n + b];
          EXPECT_NEAR(sum, 0., 1e-9 * volume / 50.);
        }
    }
}


TEST(EnclosedContent, PressureIsTheDerivativeOfTheEnergy)
{
  EnclosedContent content;
  content.gas                 = 700.;
  content.pressure_at_target  = 0.3;
  content.stiffness_at_target = 0.02;
  content.target              = 950.;
  const double eps            = 1e-3;
  for (const double V : {500., 900., 1700.})
    {
      EXPECT_NEAR((content.energy(V - eps, 1000.) -
                   content.energy(V + eps, 1000.)) /
                    (2. * eps),
                  content.pressure(V),
                  1e-8 * std::abs(content.pressure(V)));
      EXPECT_NEAR((content.pressure(V - eps) - content.pressure(V + eps)) /
                    (2. * eps),
                  content.stiffness(V),
                  1e-8 * content.stiffness(V));
    }
  EXPECT_FALSE(std::isfinite(content.energy(-1., 1000.)));
  EXPECT_EQ(EnclosedContent().energy(900., 1000.), 0.);
}
