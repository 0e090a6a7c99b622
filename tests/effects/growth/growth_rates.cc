// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  /** Neither along an axis nor of special components. */
  template <int dim>
  Tensor<1, dim>
  some_direction()
  {
    Tensor<1, dim> a;
    for (unsigned int i = 0; i < dim; ++i)
      a[i] = 0.3 + 0.7 * i;
    return a / a.norm();
  }
} // namespace


/** e^{k_par dt} a⊗a + e^{k_perp dt} (I − a⊗a). */
TEST_2D_3D(GrowthRates, GrowAsTheClosedForm)
{
  const auto           a  = some_direction<dim>();
  const Tensor<2, dim> aa = outer_product(a, a);
  const Tensor<2, dim> I  = unit_tensor<dim>();
  Tensor<2, dim>       before(I);
  before[0][1] = 0.2;
  before[1][1] = 1.3;
  for (const auto &[along, across] : {std::pair<double, double>{0.7, 0.},
                                      {0., 0.4},
                                      {-0.3, 0.9},
                                      {0.25, 0.25}})
    {
      const auto L   = rate_along_and_across(a, along, across);
      const auto now = grown(before, L, 0.5);
      const auto exact =
        (std::exp(0.5 * along) * aa + std::exp(0.5 * across) * (I - aa)) *
        before;
      EXPECT_LE((now - exact).norm(), 4e-15);
      EXPECT_NEAR(std::log(determinant(now) / determinant(before)),
                  0.5 * (along + (dim - 1) * across),
                  1e-14);
      // Two halves are one step, and back again is nothing.
      EXPECT_LE((grown(grown(before, L, 0.2), L, 0.3) - now).norm(), 1e-14);
      EXPECT_LE((grown(now, L, -0.5) - before).norm(), 1e-14);
    }
}


// The exact solution of k' = -c (k - r), and its mean over a step.
TEST(GrowthRates, PredictBetweenFreeAndHeld)
{
  const auto of = [](const double k, const double c, const double r) {
    return predicted_rate({k, c}, {k, c}, r);
  };
  EXPECT_NEAR(of(1., 1., 0.), 0.632120558828558, 1e-15);
  EXPECT_NEAR(of(1., 1e-9, 0.), 1. - 5e-10, 1e-15);
  EXPECT_NEAR(of(1., 1e6, 0.), 1e-6, 1e-15);
  EXPECT_NEAR(of(1., 9.999e-4, 0.), 0.9995002165917, 1e-13);
  EXPECT_NEAR(of(1., 1.0001e-3, 0.), 0.9995001166583, 1e-13);
  const double phi = -std::expm1(-3.) / 3.;
  EXPECT_DOUBLE_EQ(of(0.5, 3., 0.), 0.5 * phi);
  EXPECT_DOUBLE_EQ(of(0.5, 3., 0.5), 0.5);
  EXPECT_DOUBLE_EQ(of(0.5, 3., 0.25), 0.25 + 0.25 * phi);
  // A place that narrows does not turn growth into shrinkage.
  EXPECT_DOUBLE_EQ(of(0.5, 3., -4.), 0.5 * phi);
  EXPECT_DOUBLE_EQ(of(-0.5, 3., -0.5), -0.5);
  EXPECT_DOUBLE_EQ(of(-0.5, 3., 0.5), -0.5 * phi);
  EXPECT_EQ(of(0.5, 0., 0.1), 0.5);
}


TEST(GrowthRates, ExpectWhatIsLeftAtTheEnd)
{
  const auto of = [](const double k, const double c, const double r) {
    return expected_rate({k, c}, {k, c}, r);
  };
  EXPECT_NEAR(of(1., 1., 0.), 0.367879441171442, 1e-15);
  EXPECT_NEAR(of(1., 1e6, 0.), 0., 1e-10);
  EXPECT_NEAR(of(1., 2., 0.4), 0.4 + 0.6 * std::exp(-2.), 1e-15);
  EXPECT_EQ(of(0.5, 0., 0.1), 0.5);
  const GrowthFeedback k{0.5, 1.}, h{0.1, 2.}, all{0.6, 3.};
  EXPECT_DOUBLE_EQ(expected_rate(k, all, 0.2) + expected_rate(h, all, 0.2),
                   expected_rate(all, all, 0.2));
}


TEST(GrowthRates, PredictPartsThatAddUp)
{
  const GrowthFeedback k{0.5, 1.}, h{0.1, 2.}, all{0.6, 3.};
  EXPECT_DOUBLE_EQ(predicted_rate(k, all, 0.2) + predicted_rate(h, all, 0.2),
                   predicted_rate(all, all, 0.2));
  // What has no feedback is not damped by that of the other part.
  EXPECT_EQ(predicted_rate({0.5, 0.}, {0.4, 7.}, 0.1), 0.5);
}


TEST(GrowthRates, FirstStepIsMadeGoodWhereTheTissueGaveWay)
{
  // k dt = 0.1 and c = 4: 0.02 has grown.
  const FirstStep free = after_first_step(0.02, 0.08, 0., 0.2);
  EXPECT_NEAR(free.due, 0.08, 1e-15);
  EXPECT_NEAR(free.widening, 0.5, 1e-15);
  const FirstStep held = after_first_step(0.02, 0.08, 0.02, 0.2);
  EXPECT_NEAR(held.due, 0., 1e-15);
  EXPECT_NEAR(held.widening, 0., 1e-15);
  // Half of it: k dt / (1 + c/2) were right.
  const FirstStep half = after_first_step(0.02, 0.08, 0.01, 0.2);
  EXPECT_NEAR(0.02 + half.due, 0.1 / 3., 1e-15);
  EXPECT_NEAR(half.widening * 0.2, 0.05 / 3., 1e-15);
  // Nothing grew, or it was pulled.
  EXPECT_EQ(after_first_step(0., 0., 0.1, 0.2).due, 0.);
  EXPECT_NEAR(after_first_step(0.02, 0.08, -0.5, 0.2).due, 0.08, 1e-15);
}
