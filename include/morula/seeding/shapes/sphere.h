// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_shapes_sphere_h
#define morula_seeding_shapes_sphere_h

#include <morula/seeding/shape.h>

namespace Morula
{
  /** A ball; in 2-D, a disc. It may have a concentric cavity. */
  template <int dim>
  class Sphere : public Shape<dim>
  {
  public:
    /** @param radius µm
     *  @param inner_radius of the cavity, µm; 0: there is none */
    Sphere(const Point<dim> &center,
           const double      radius,
           const double      inner_radius = 0.);

    BoundingBox<dim>
    bounding_box() const override;

    bool
    contains(const Point<dim> &x, const double clearance) const override;

    double
    volume() const override;

    double
    surface_area() const override;

    /**
     * In 3-D, a golden spiral from the top to the bottom,
     * z_i = R (1 - (2i+1)/n); in 2-D, the middles of equal arcs. All patches
     * have equal areas; there are at least dim + 1 of them. Those of a cavity
     * follow in the same way, about as large.
     */
    SurfaceTiling<dim>
    tile(const std::uint64_t n_wished) const override;

  private:
    Point<dim> center;
    double     radius, inner_radius;
  };
} // namespace Morula

#endif
