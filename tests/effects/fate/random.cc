// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  constexpr std::uint64_t seed      = 7;
  constexpr unsigned int  n_samples = 40000;

  double
  correlation(const std::vector<double> &a, const std::vector<double> &b)
  {
    const double n = a.size();
    double       A = 0., B = 0., AA = 0., BB = 0., AB = 0.;
    for (unsigned int i = 0; i < a.size(); ++i)
      {
        A += a[i] / n;
        B += b[i] / n;
        AA += a[i] * a[i] / n;
        BB += b[i] * b[i] / n;
        AB += a[i] * b[i] / n;
      }
    return (AB - A * B) / std::sqrt((AA - A * A) * (BB - B * B));
  }

  double
  wait(const std::uint64_t key)
  {
    return Random::exponential(seed, key, 1.);
  }
} // namespace


// The first known answer that Random123 publishes for philox4x32-10: counter
// and key zero give 6627e8d5 e169c58d bc57ac4c 9b00dbd8.
TEST(Random, KnownAnswer)
{
  const std::uint64_t bits = 0xe169c58d6627e8d5u;
  const double        u    = ((bits >> 11) + 1) / 9007199254740992.;
  EXPECT_DOUBLE_EQ(Random::exponential(0, 0, 1.), -std::log(u));
}


TEST(Random, WaitIsExponential)
{
  for (const double rate : {0.25, 1., 3.})
    {
      std::vector<double> waits;
      for (unsigned int id = 0; id < n_samples; ++id)
        waits.push_back(-std::expm1(
          -rate *
          Random::exponential(seed, Random::founder_key(seed, id), rate)));

      EXPECT_GE(*std::min_element(waits.begin(), waits.end()), 0.);
      EXPECT_LT(chi_squared(waits), largest_chi_squared);
    }
}


TEST(Random, RateScalesTheWait)
{
  EXPECT_DOUBLE_EQ(Random::exponential(seed, 5, 4.), 0.25 * wait(5));
  EXPECT_TRUE(std::isinf(Random::exponential(seed, 5, 0.)));
}


TEST(Random, DirectionIsUniformOnTheSphere)
{
  // On the unit sphere, the component along any direction is uniform.
  Tensor<1, 3> oblique({2. / 3., -1. / 3., 2. / 3.});

  std::vector<std::vector<double>> components(4);
  Tensor<2, 3>                     second_moment;
  for (unsigned int id = 0; id < n_samples; ++id)
    {
      const auto n = Random::direction<3>(seed, Random::founder_key(seed, id));
      EXPECT_NEAR(n.norm(), 1., 1e-15);
      for (unsigned int d = 0; d < 3; ++d)
        components[d].push_back(0.5 + 0.5 * n[d]);
      components[3].push_back(0.5 + 0.5 * n * oblique);
      second_moment += outer_product(n, n) / n_samples;
    }

  for (const auto &samples : components)
    EXPECT_LT(chi_squared(samples), largest_chi_squared);
  // Variances: of n_i^2 4/45, of n_i n_j 1/15.
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      EXPECT_NEAR(second_moment[i][j],
                  i == j ? 1. / 3. : 0.,
                  4. * std::sqrt((i == j ? 4. / 45. : 1. / 15.) / n_samples));
}


TEST(Random, DirectionIsUniformOnTheCircle)
{
  std::vector<double> angles;
  for (unsigned int id = 0; id < n_samples; ++id)
    {
      const auto n = Random::direction<2>(seed, Random::founder_key(seed, id));
      EXPECT_NEAR(n.norm(), 1., 1e-15);
      angles.push_back(0.5 + 0.5 * std::atan2(n[1], n[0]) / numbers::PI);
    }
  EXPECT_LT(chi_squared(angles), largest_chi_squared);
}


TEST(Random, RelativesAreIndependent)
{
  std::vector<double> mother, first, second, next_founder, other_seed, axis;
  for (unsigned int id = 0; id < n_samples; ++id)
    {
      const std::uint64_t key = Random::founder_key(seed, id);
      mother.push_back(wait(key));
      first.push_back(wait(Random::daughter_key(seed, key, 0)));
      second.push_back(wait(Random::daughter_key(seed, key, 1)));
      next_founder.push_back(wait(Random::founder_key(seed, id + 1)));
      other_seed.push_back(
        Random::exponential(seed + 1, Random::founder_key(seed + 1, id), 1.));
      axis.push_back(Random::direction<3>(seed, key)[2]);
    }

  // A lineage key may be as small a number as a founder's id: the founder's key
  // is not what such a cell draws its wait from.
  for (const std::uint64_t id : {0, 1, 7})
    EXPECT_NE(wait(id),
              -std::log(
                std::ldexp((Random::founder_key(seed, id) >> 11) + 1., -53)));

  // A correlation of independent samples has variance 1/n.
  const double tolerance = 4. / std::sqrt(n_samples);
  for (const auto &other : {first, second, next_founder, other_seed, axis})
    EXPECT_NEAR(correlation(mother, other), 0., tolerance);
  EXPECT_NEAR(correlation(first, second), 0., tolerance);
}
