// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_shapes_ellipsoid_h
#define morula_seeding_shapes_ellipsoid_h

#include <morula/seeding/shape.h>

#include <array>

namespace Morula
{
  /** An axis-parallel ellipsoid; in 2-D, an ellipse. */
  template <int dim>
  class Ellipsoid : public Shape<dim>
  {
  public:
    /** @param half_axes µm */
    Ellipsoid(const Point<dim> &center, const Tensor<1, dim> &half_axes);

    BoundingBox<dim>
    bounding_box() const override
    {
      return BoundingBox<dim>({center - half_axes, center + half_axes});
    }

    /** Estimates the distance to the surface to first order. */
    bool
    contains(const Point<dim> &x, const double clearance) const override;

    double
    volume() const override;

    /**
     * Exact: 4 pi R_G(a²b², a²c², b²c²) with Carlson's symmetric elliptic
     * integral (DLMF 19.33.1); in 2-D 4 a E(k), k² = 1 - b²/a².
     */
    double
    surface_area() const override;

    /**
     * The sphere's golden spiral, mapped such that areas are preserved: the
     * band above each latitude has the same fraction of the area as on the
     * sphere, and the part of a parallel west of each point the same fraction
     * of the area density along the parallel. In 2-D, the middles of equal
     * arcs. All patches have equal areas; there are at least dim + 1 of them.
     */
    SurfaceTiling<dim>
    tile(const std::uint64_t n_wished) const override;

  private:
    /**
     * The patch around the point center + @p from_center of the surface, with
     * the normal there.
     */
    SurfacePatch<dim>
    patch_at(const Tensor<1, dim> &from_center, const double area) const;

    Point<dim>     center;
    Tensor<1, dim> half_axes;
    /**
     * Coordinate directions: first the longer and the shorter axis of the
     * parallels, then (3-D) the axis of the spiral, whose length differs most
     * from the others.
     */
    std::array<unsigned int, dim> order;
  };
} // namespace Morula

#endif
