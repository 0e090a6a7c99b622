// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_shapes_rings_h
#define morula_seeding_shapes_rings_h

#include <cstdint>
#include <vector>

namespace Morula
{
  /** Where a patch sits in a surface that is cut into rings. */
  struct RingPlace
  {
    /** Part of the whole area that lies before the middle of its ring. */
    double area_before;
    /** Angle around the axis. */
    double angle;
    /** The patch's part of the whole area. */
    double area;
  };

  /**
   * Cuts a surface of revolution into rings, and those into patches of equal
   * area, evenly around the axis.
   */
  class Rings
  {
  public:
    /**
     * @param n_patches   their number
     * @param area_before for each ring but the last, the part of the area up to
     *                    its end, increasing; it is met to half a patch
     */
    Rings(const std::uint64_t        n_patches,
          const std::vector<double> &area_before);

    /** The @p i-th patch, ring by ring. */
    RingPlace
    place(const std::uint64_t i) const;

    std::uint64_t
    n_patches() const;

  private:
    // number of patches before each ring's end, the first entry 0
    std::vector<std::uint64_t> ends;
  };
} // namespace Morula

#endif
