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
    bounding_box() const override;

    /** The distance to the surface is estimated to first order. */
    bool
    contains(const Point<dim> &x, const double clearance) const override;

    /**
     * Exact: 4 pi R_G(a²b², a²c², b²c²) with Carlson's symmetric elliptic
     * integral (DLMF 19.33.1); in 2-D 4 a E(k), k² = 1 - b²/a².
     */
    double
    volume() const override;

    double
    surface_area() const override;

    /**
     * The sphere's golden spiral in coordinates that preserve area: the band
     * above each latitude and the part of a parallel west of each point have
     * the fractions of the area, and of the density along the parallel, that
     * they have on the sphere. 2-D: the middles of equal arcs. Patches of equal
     * area, at least dim + 1 of them.
     */
    SurfaceTiling<dim>
    tile(const std::uint64_t n_wished) const override;

  private:
    /**
     * The normal of the point center + @p from_center of the surface, and the
     * patch around it.
     */
    SurfacePatch<dim>
    patch_at(const Tensor<1, dim> &from_center, const double area) const;

    Point<dim>     center;
    Tensor<1, dim> half_axes;
    /**
     * Coordinate directions: the longer and the shorter axis of the parallels,
     * then (3-D) the spiral's axis, which is the one least like the others.
     */
    std::array<unsigned int, dim> order;
  };
} // namespace Morula

#endif
