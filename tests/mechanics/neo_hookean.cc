// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/neo_hookean.h>

#include <gtest/gtest.h>

#include <random>

#include "common/body_on_grid.h"

using namespace Morula;

namespace
{
  template <int dim>
  Tensor<2, dim>
  random_deformation(std::mt19937 &generator)
  {
    return unit_tensor<dim>() + 0.3 * random_tensor<2, dim>(generator);
  }

  template <int dim>
  void
  check_stress()
  {
    const double eps = 1e-5;
    std::mt19937 generator(1);
    for (unsigned int trial = 0; trial < 50; ++trial)
      {
        const Lame           material = lame(2.5, 0.05 * (trial % 10));
        const Tensor<2, dim> F        = random_deformation<dim>(generator);
        // First Piola-Kirchhoff stress dΨ/dF = τ F⁻ᵀ.
        const Tensor<2, dim> P =
          Tensor<2, dim>(NeoHookean<dim>(F, material).kirchhoff_stress()) *
          transpose(invert(F));
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            {
              Tensor<2, dim> before = F, after = F;
              before[i][j] -= eps;
              after[i][j] += eps;
              EXPECT_NEAR((NeoHookean<dim>(after, material).energy() -
                           NeoHookean<dim>(before, material).energy()) /
                            (2. * eps),
                          P[i][j],
                          1e-7 * (1. + P.norm()));
            }
      }
  }

  template <int dim>
  void
  check_rest()
  {
    const Lame material = lame(3., 0.4);
    for (const double angle : {0., 0.7, 3.})
      {
        Tensor<2, dim> Q = unit_tensor<dim>();
        Q[0][0] = Q[1][1] = std::cos(angle);
        Q[0][1]           = -(Q[1][0] = std::sin(angle));
        const NeoHookean<dim> turned(Q, material);
        EXPECT_NEAR(turned.energy(), 0., 1e-15);
        EXPECT_NEAR(turned.kirchhoff_stress().norm(), 0., 1e-14);
        EXPECT_NEAR(turned.J(), 1., 1e-15);
      }
  }
} // namespace


TEST(NeoHookean,
     StressIsTheEnergysDerivative){MORULA_BOTH_DIMENSIONS(check_stress)}


TEST(NeoHookean, RotationsCostNothing){MORULA_BOTH_DIMENSIONS(check_rest)}


TEST(NeoHookean, PlaneStrainIsThreeDimensionalWithoutStretchInZ)
{
  std::mt19937 generator(2);
  for (unsigned int trial = 0; trial < 20; ++trial)
    {
      const Tensor<2, 2> F = random_deformation<2>(generator);
      Tensor<2, 3>       F_3d;
      F_3d[2][2] = 1.;
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int j = 0; j < 2; ++j)
          F_3d[i][j] = F[i][j];
      const Lame          material = lame(1.7, 0.3);
      const NeoHookean<2> plane(F, material);
      const NeoHookean<3> solid(F_3d, material);
      EXPECT_NEAR(plane.energy(), solid.energy(), 1e-14);
      EXPECT_NEAR(plane.J(), solid.J(), 1e-14);
      for (unsigned int i = 0; i < 2; ++i)
        for (unsigned int j = 0; j < 2; ++j)
          EXPECT_NEAR(plane.kirchhoff_stress()[i][j],
                      solid.kirchhoff_stress()[i][j],
                      1e-14);
      EXPECT_NEAR(plane.kirchhoff_stress_zz(),
                  solid.kirchhoff_stress_zz(),
                  1e-14);
      EXPECT_NEAR(plane.mu_minus_lambda_log_J(),
                  solid.mu_minus_lambda_log_J(),
                  1e-14);
    }
}


TEST(NeoHookean, LameConstants)
{
  const Lame rubber = lame(1., 0.4);
  EXPECT_NEAR(rubber.lambda, 10. / 7., 1e-15);
  EXPECT_NEAR(rubber.mu, 5. / 14., 1e-15);
  EXPECT_EQ(lame(2., 0.).lambda, 0.);
  EXPECT_EQ(lame(2., 0.).mu, 1.);
  // The bulk modulus diverges for incompressible material.
  EXPECT_NEAR(lame(3., 0.4999).lambda, 3. * 0.4999 / (1.4999 * 0.0002), 1e-6);
}


// Growth θ in a rigid box, per grown volume.
TEST(NeoHookean, PressureInARigidBox)
{
  const std::pair<double, double> pressures[] = {{1.1, 626.18}, {1.4, 4436.91}};
  for (const auto &[theta, pascal] : pressures)
    {
      const NeoHookean<3> grown(unit_tensor<3>() / theta, lame(1., 0.4));
      EXPECT_NEAR(-1e3 * trace(grown.kirchhoff_stress()) / 3. * theta * theta *
                    theta,
                  pascal,
                  0.005);
    }
}
