// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  /** A rotation about no special axis. */
  template <int dim>
  Tensor<2, dim>
  rotation_of_test()
  {
    using namespace Physics::Transformations::Rotations;
    if constexpr (dim == 2)
      return rotation_matrix_2d(0.7);
    else
      return rotation_matrix_3d(Tensor<1, 3>({2. / 3., -1. / 3., 2. / 3.}),
                                0.7);
  }

  /** Stretches along the columns of Q, then turned by R: V = Q diag Q^T. */
  template <int dim>
  Tensor<2, dim>
  deformation(const std::vector<double> &stretches)
  {
    const Tensor<2, dim> Q = rotation_of_test<dim>();
    return Q * diagonal<dim>(stretches) * transpose(Q) * Q * Q;
  }

  template <int dim>
  Tensor<1, dim>
  column(const Tensor<2, dim> &Q, const unsigned int d)
  {
    return transpose(Q)[d];
  }

  template <int dim>
  Tensor<1, dim>
  some_sign()
  {
    Tensor<1, dim> sign;
    for (unsigned int d = 0; d < dim; ++d)
      sign[d] = d == 1 ? -0.8 : 0.6;
    return sign;
  }

  template <int dim>
  SymmetricTensor<2, 3>
  stress(const std::vector<double> &principal)
  {
    Tensor<2, dim> diagonal;
    for (unsigned int d = 0; d < dim; ++d)
      diagonal[d][d] = principal[d];
    const Tensor<2, dim> Q     = rotation_of_test<dim>();
    const Tensor<2, dim> sigma = Q * diagonal * transpose(Q);
    // 2-D: out of the plane larger than any in it.
    SymmetricTensor<2, 3> result;
    result[2][2] = 100.;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        result[i][j] = sigma[i][j];
    return result;
  }
} // namespace


TEST_2D_3D(Directions, OfTheLargestStretch)
{
  const std::vector<double> stretches = {1.02, 1.1, 0.9};
  const auto axis = Directions::of_largest_stretch(deformation<dim>(stretches),
                                                   1.02,
                                                   some_sign<dim>());
  ASSERT_TRUE(axis.has_value());
  EXPECT_GT(*axis * some_sign<dim>(), 0.);
  EXPECT_NEAR(std::abs(*axis * column(rotation_of_test<dim>(), 1)), 1., 1e-12);
  const auto opposite =
    Directions::of_largest_stretch(deformation<dim>(stretches),
                                   1.02,
                                   -some_sign<dim>());
  EXPECT_LT((*axis + *opposite).norm(), 1e-15);
  // The ratio that counts is that of the two largest, 1.1/1.02.
  EXPECT_FALSE(Directions::of_largest_stretch(deformation<dim>(stretches),
                                              1.08,
                                              some_sign<dim>()));
  EXPECT_TRUE(Directions::of_largest_stretch(deformation<dim>(stretches),
                                             1.07,
                                             some_sign<dim>()));
}

TEST_2D_3D(Directions, OfTheLargestStress)
{
  // Least compressed is most tensile.
  const std::vector<double> principal = {-3., -1., -2.};
  constexpr double          mu        = 10.;
  const auto axis = Directions::of_largest_stress(stress<dim>(principal),
                                                  mu,
                                                  1.02,
                                                  some_sign<dim>());
  ASSERT_TRUE(axis.has_value());
  EXPECT_GT(*axis * some_sign<dim>(), 0.);
  EXPECT_NEAR(std::abs(*axis * column(rotation_of_test<dim>(), 1)), 1., 1e-12);
  // 2-D: 1 + 2/20, 3-D: 1 + 1/20
  const double measure = dim == 2 ? 1.1 : 1.05;
  EXPECT_TRUE(Directions::of_largest_stress(
    stress<dim>(principal), mu, measure - 1e-9, some_sign<dim>()));
  EXPECT_FALSE(Directions::of_largest_stress(
    stress<dim>(principal), mu, measure + 1e-9, some_sign<dim>()));
}

/** No direction is singled out, however small a ratio is asked for. */
TEST_2D_3D(Directions, NoneWhereStatesAreIsotropic)
{
  const Tensor<2, dim> unit(unit_symmetric_tensor<dim>());
  EXPECT_FALSE(
    Directions::of_largest_stretch(1.3 * unit, 1., some_sign<dim>()));
  EXPECT_FALSE(Directions::of_largest_stress(
    stress<dim>({0., 0., 0.}), 1., 1., some_sign<dim>()));
  // Two equal largest stretches in 3-D, or all in 2-D.
  EXPECT_FALSE(Directions::of_largest_stretch(deformation<dim>({1.2, 1.2, 0.8}),
                                              1.0001,
                                              some_sign<dim>()));
}

TEST_2D_3D(Directions, CarriedNormal)
{
  Tensor<2, dim> F = deformation<dim>({1.5, 0.8, 1.1});
  F[0][1] += 0.4;
  const Tensor<1, dim> N      = column(rotation_of_test<dim>(), 0);
  const Tensor<1, dim> normal = Directions::carried_normal(F, N);
  EXPECT_NEAR(normal.norm(), 1., 1e-15);
  // Perpendicular to what was perpendicular to N; still outward.
  for (unsigned int d = 1; d < dim; ++d)
    EXPECT_NEAR(normal * (F * column(rotation_of_test<dim>(), d)), 0., 1e-15);
  EXPECT_GT(normal * (F * N), 0.);
}

TEST(Directions, AcrossTheAxisItself)
{
  const Tensor<1, 3> axis({0., 0., 1.});
  EXPECT_NEAR(Directions::across(axis, axis).norm(), 1., 1e-15);
  EXPECT_NEAR(Directions::across(axis, axis) * axis, 0., 1e-15);
}

TEST(Directions, AcrossIsUniformInThePlane)
{
  const Tensor<1, 3>  axis   = column(rotation_of_test<3>(), 0);
  const Tensor<1, 3>  first  = column(rotation_of_test<3>(), 1);
  const Tensor<1, 3>  second = column(rotation_of_test<3>(), 2);
  std::vector<double> turns;
  for (unsigned int id = 0; id < 20000; ++id)
    {
      const Tensor<1, 3> tangent =
        Directions::across(axis,
                           Random::direction<3>(5, Random::founder_key(5, id)));
      EXPECT_NEAR(tangent.norm(), 1., 1e-15);
      EXPECT_NEAR(tangent * axis, 0., 1e-11);
      turns.push_back(0.5 + 0.5 *
                              std::atan2(tangent * second, tangent * first) /
                              numbers::PI);
    }
  EXPECT_LT(chi_squared(turns), largest_chi_squared);
}
