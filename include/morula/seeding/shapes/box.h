// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_shapes_box_h
#define morula_seeding_shapes_box_h

#include <morula/seeding/shape.h>

namespace Morula
{
  /** An axis-parallel box; in 2-D, a rectangle. */
  template <int dim>
  class Box : public Shape<dim>
  {
  public:
    /** @param size full edge lengths, µm */
    Box(const Point<dim> &center, const Tensor<1, dim> &size);

    BoundingBox<dim>
    bounding_box() const override
    {
      return BoundingBox<dim>({center - 0.5 * size, center + 0.5 * size});
    }

    bool
    contains(const Point<dim> &x, const double clearance) const override;

    double
    volume() const override;

    double
    surface_area() const override;

    /**
     * A grid of patches on each face: -x, +x, -y, ...; within a face the lower
     * coordinate fastest. Edges of equal length have equal numbers of patches.
     */
    SurfaceTiling<dim>
    tile(const std::uint64_t n_wished) const override;

  private:
    Point<dim>     center;
    Tensor<1, dim> size;
  };
} // namespace Morula

#endif
