// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_effects_samples_h
#define morula_tests_effects_samples_h

namespace Morula
{
  /** Chi-squared with 19 degrees of freedom is above it with probability
   *  0.001. */
  constexpr double largest_chi_squared = 43.82;

  /** Chi-squared of values that ought to be uniform in [0, 1], in 20 bins. */
  inline double
  chi_squared(const std::vector<double> &values)
  {
    constexpr unsigned int    n_bins = 20;
    std::vector<unsigned int> counts(n_bins, 0);
    for (const double value : values)
      ++counts[std::min(n_bins - 1, static_cast<unsigned int>(value * n_bins))];
    const double expected = static_cast<double>(values.size()) / n_bins;
    double       sum      = 0.;
    for (const unsigned int count : counts)
      sum += (count - expected) * (count - expected) / expected;
    return sum;
  }
} // namespace Morula

#endif
