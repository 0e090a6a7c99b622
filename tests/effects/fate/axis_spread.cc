// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  constexpr std::uint64_t seed      = 11;
  constexpr unsigned int  n_samples = 40000;

  template <int dim>
  Tensor<1, dim>
  oblique()
  {
    Tensor<1, dim> axis;
    for (unsigned int d = 0; d < dim; ++d)
      axis[d] = 1. - 0.7 * d;
    return axis / axis.norm();
  }

  template <int dim>
  Tensor<1, dim>
  sample(const double kappa, const unsigned int id)
  {
    return Random::direction_around(oblique<dim>(),
                                    kappa,
                                    seed,
                                    Random::founder_key(seed, id));
  }

  /** Of the angle to the axis: a closed form in 3-D, the trapezoidal rule in
   *  2-D. */
  template <int dim>
  double
  distribution_function(const double kappa, const double angle)
  {
    if (dim == 3)
      return std::expm1(-kappa * (1. - std::cos(angle))) /
             std::expm1(-2. * kappa);
    const auto integral = [kappa](const double end) {
      constexpr unsigned int n   = 400;
      double                 sum = 0.;
      for (unsigned int i = 0; i <= n; ++i)
        sum += (i == 0 || i == n ? 0.5 : 1.) *
               std::exp(kappa * (std::cos(end * i / n) - 1.));
      return sum * end / n;
    };
    return integral(angle) / integral(numbers::PI);
  }

  template <int dim>
  void
  check_angles(const double kappa)
  {
    std::vector<double> angles, sides;
    for (unsigned int id = 0; id < n_samples; ++id)
      {
        const Tensor<1, dim> n = sample<dim>(kappa, id);
        EXPECT_NEAR(n.norm(), 1., 1e-15);
        const double angle =
          std::acos(std::min(1., std::max(-1., n * oblique<dim>())));
        angles.push_back(distribution_function<dim>(kappa, angle));
        // Which way: uniform around the axis; in 2-D one way or the other.
        const Tensor<1, dim> side = Directions::across(oblique<dim>(), n);
        if constexpr (dim == 3)
          {
            const Tensor<1, 3> first =
              Directions::across(oblique<3>(), Tensor<1, 3>({0., 0., 1.}));
            const double turn =
              std::atan2(side * cross_product_3d(oblique<3>(), first),
                         side * first);
            sides.push_back(0.5 + 0.5 * turn / numbers::PI);
          }
        else
          sides.push_back(side[0] > 0. ? 1. : 0.);
      }
    EXPECT_LT(chi_squared(angles), largest_chi_squared) << "kappa = " << kappa;
    if (dim == 3)
      EXPECT_LT(chi_squared(sides), largest_chi_squared) << "kappa = " << kappa;
    else
      {
        double sum = 0.;
        for (const double side : sides)
          sum += side;
        EXPECT_NEAR(sum / n_samples, 0.5, 4. * 0.5 / std::sqrt(n_samples));
      }
  }
} // namespace


TEST(AxisSpread, AnglesAreThoseOfVonMisesAndFisher)
{
  for (const double kappa : {0.1, 1., 4., 30.})
    {
      check_angles<2>(kappa);
      check_angles<3>(kappa);
    }
}


namespace
{
  /** κ times the mean of 1 - cos, which tends to (dim - 1)/2. */
  template <int dim>
  void
  check_large(const double kappa)
  {
    double mean = 0.;
    for (unsigned int id = 0; id < n_samples; ++id)
      mean += 0.5 * kappa *
              (sample<dim>(kappa, id) - oblique<dim>()).norm_square() /
              n_samples;
    // Its variance is (dim - 1)/2.
    EXPECT_NEAR(mean,
                0.5 * (dim - 1),
                4. * std::sqrt(0.5 * (dim - 1) / n_samples));
  }
} // namespace

TEST(AxisSpread, LargeConcentrationsAreGaussian)
{
  for (const double kappa : {1e4, 1e8})
    {
      check_large<2>(kappa);
      check_large<3>(kappa);
    }
  EXPECT_LT((sample<2>(1e300, 1) - oblique<2>()).norm(), 1e-5);
  EXPECT_LT((sample<3>(1e300, 1) - oblique<3>()).norm(), 1e-5);
}


// Ranks know an axis but for rounding.
TEST(AxisSpread, ChangesLittleWithTheAxis)
{
  for (const auto &axis : {Tensor<1, 3>({0., 0., 1.}),
                           Tensor<1, 3>({1., 0., 0.}),
                           Tensor<1, 3>({0., -1., 0.})})
    for (unsigned int d = 0; d < 3; ++d)
      for (unsigned int id = 0; id < 100; ++id)
        {
          Tensor<1, 3> other = axis;
          other[d] += 1e-12;
          other /= other.norm();
          const std::uint64_t key = Random::founder_key(seed, id);
          EXPECT_LT((Random::direction_around(axis, 5., seed, key) -
                     Random::direction_around(other, 5., seed, key))
                      .norm(),
                    1e-9);
        }
}
