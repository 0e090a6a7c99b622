// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_limits_h
#define morula_seeding_limits_h

#include <morula/seeding/seeding.h>

#include <functional>

namespace Morula
{
  /** Largest distance from the origin, in units of h. Farther out positions
   *  lose their digits, and grid cells are counted by integers. */
  constexpr double farthest_place = 1e8;

  /** Longest tissue along an axis, in units of h. A box of this length in all
   *  directions is more than any machine holds. In one direction it is some
   *  metres of tissue, and nearly always due to a single stray point. */
  constexpr double longest_tissue = 1000.;

  /** Longest cell, in units of h. A cell deforms as a whole, and one of this
   *  length takes longest_cell^dim quadrature points. */
  constexpr double longest_cell = 10.;

  /**
   * Refuses shapes and cells whose lengths, as the scene gives them, are beyond
   * these limits on a grid of spacing @p h (µm).
   * @throws InputError
   */
  void
  check_lengths(const TissueParameters &tissue,
                const double            h,
                const unsigned int      dim);

  /** Refuses a tissue of so many cells, with this volume (µm^dim), on a grid of
   *  so many grid cells, if the machines' memory cannot hold it. Collective. */
  using MemoryCheck =
    std::function<void(const double, const double, const double)>;

  /** The limits for tissue from files on a grid of spacing @p h (µm). */
  template <int dim>
  SeedingLimits<dim>
  seeding_limits(const TissueParameters &tissue,
                 const double            h,
                 const MemoryCheck      &check_memory);
} // namespace Morula

#endif
