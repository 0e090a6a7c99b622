// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/balance_warning.h>

#include <algorithm>
#include <sstream>

namespace Morula
{
  std::optional<std::string>
  balance_warning(const std::vector<ForceRow> &rows,
                  const double                 t,
                  const double                 least)
  {
    // What acts between bodies of the tissue has no part in the sum.
    // A hundredth is more than Newton's method and patches leave.
    constexpr double largest_rest = 0.01;
    Tensor<1, 3>     sum;
    double           magnitude = 0.;
    for (const ForceRow &row : rows)
      if (!row.is_internal)
        {
          sum += row.force;
          magnitude += row.force.norm();
        }
    if (!(sum.norm() > std::max(least, largest_rest * magnitude)))
      return {};
    std::ostringstream text;
    text << "Warning: at t = " << t
         << " day the forces on the tissue add up to (" << sum
         << ") kPa um^2 (2-D: kPa um), " << sum.norm() / magnitude
         << " of their sizes: what is left, the weak drag (4.8f) balances, so "
            "the tissue, or a piece of it, drifts until an obstacle stops it. "
            "Hold it by Fixed where or Slip where, or give it Friction. Later "
            "times are not told of.";
    return text.str();
  }
} // namespace Morula
