// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/shapes/rings.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  Rings::Rings(const std::uint64_t        n_patches,
               const std::vector<double> &area_before)
    : ends(1, 0)
  {
    // A ring ends where the patches so far have the area so far, rounded. Rings
    // without patches are left out.
    for (const double area : area_before)
      {
        const auto end = static_cast<std::uint64_t>(
          std::round(area * static_cast<double>(n_patches)));
        if (end > ends.back() && end < n_patches)
          ends.push_back(end);
      }
    ends.push_back(n_patches);
  }

  RingPlace
  Rings::place(const std::uint64_t i) const
  {
    const auto end  = std::upper_bound(ends.begin(), ends.end(), i);
    const auto ring = std::distance(ends.begin(), end);

    const double n     = static_cast<double>(n_patches());
    const double first = static_cast<double>(*(end - 1));
    const double count = static_cast<double>(*end) - first;
    // Every second ring begins half a patch later, so that patches do not stand
    // in rows.
    const double shift = ring % 2 == 0 ? 0.75 : 0.25;
    return {(first + 0.5 * count) / n,
            2. * dealii::numbers::PI *
              (static_cast<double>(i) - first + shift) / count,
            1. / n};
  }
} // namespace Morula
