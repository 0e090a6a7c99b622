// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_shapes_rings_h
#define morula_seeding_shapes_rings_h

#include <cstdint>
#include <vector>

namespace Morula
{
  /** The place of a patch on a surface that is cut into rings. */
  struct RingPlace
  {
    /** The fraction of the whole area that lies before the middle of its ring.
     */
    double area_before;
    /** Angle around the axis, radians. */
    double angle;
    /** The patch's fraction of the whole area. */
    double area;
  };

  /**
   * Cuts a surface of revolution into rings, and each ring into patches of
   * equal area, evenly around the axis.
   */
  class Rings
  {
  public:
    /**
     * @param n_patches   number of all patches
     * @param area_before for each ring but the last, the fraction of the area
     * up to its end, increasing. A ring's end is moved by up to half a patch.
     */
    Rings(const std::uint64_t        n_patches,
          const std::vector<double> &area_before);

    /** The @p i-th patch, ring by ring. */
    RingPlace
    place(const std::uint64_t i) const;

    std::uint64_t
    n_patches() const
    {
      return ends.back();
    }

  private:
    // The number of patches before each ring's end; the first entry is 0.
    std::vector<std::uint64_t> ends;
  };
} // namespace Morula

#endif
