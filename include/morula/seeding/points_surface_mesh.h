// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_points_surface_mesh_h
#define morula_seeding_points_surface_mesh_h

#include <deal.II/base/point.h>

#include <array>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** A closed surface: of triangles, or in 2-D of segments. */
  template <int dim>
  struct ClosedSurface
  {
    /** µm. */
    std::vector<Point<dim>> vertices;
    /** The vertices of each facet: counter-clockwise when seen from outside; in
     *  2-D the inside is on the left of the way from the first to the second.
     */
    std::vector<std::array<unsigned int, dim>> facets;
  };

  /**
   * A first closed surface around cells: CGAL's alpha wrap of the points, in
   * 2-D the alpha shape of circles around them. It stands up to half of
   * @p length (µm, a cell's) away from the outermost cells. Gaps narrower than
   * @p gap lengths are closed, and a cavity is filled if no sphere of
   * (gap + 1)/2 lengths fits between the centres of the cells.
   */
  ClosedSurface<3>
  wrap_points(const std::vector<Point<3>> &points,
              const double                 length,
              const double                 gap);

  /** Wraps points in 2-D, by lines. */
  ClosedSurface<2>
  wrap_points(const std::vector<Point<2>> &points,
              const double                 length,
              const double                 gap);
} // namespace Morula

#endif
