// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_shapes_cylinder_h
#define morula_seeding_shapes_cylinder_h

#include <morula/seeding/shape.h>
#include <morula/seeding/shapes/rings.h>

namespace Morula
{
  /** A solid cylinder along z. */
  class Cylinder : public Shape<3>
  {
  public:
    /** @param radius, height radius and full height, µm */
    Cylinder(const Point<3> &center, const double radius, const double height);

    BoundingBox<3>
    bounding_box() const override;

    bool
    contains(const Point<3> &x, const double clearance) const override;

    double
    volume() const override
    {
      return cap_area() * height;
    }

    double
    surface_area() const override
    {
      return side_area() + 2. * cap_area();
    }

    /**
     * Rings of patches of equal area: on the lower cap from the middle
     * outwards, then up the side, then on the upper cap. A cap has at least one
     * patch, the side at least three.
     */
    SurfaceTiling<3>
    tile(const std::uint64_t n_wished) const override;

  private:
    double
    cap_area() const
    {
      return numbers::PI * radius * radius;
    }

    double
    side_area() const
    {
      return 2. * numbers::PI * radius * height;
    }

    /** @param side -1: lower, 1: upper */
    SurfacePatch<3>
    cap_patch(const RingPlace &place, const double side) const;

    SurfacePatch<3>
    side_patch(const RingPlace &place) const;

    Point<3> center;
    double   radius;
    double   height;
  };
} // namespace Morula

#endif
