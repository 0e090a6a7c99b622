// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_surface_file_h
#define morula_seeding_surface_file_h

#include <morula/base/key.h>
#include <morula/seeding/points_surface_mesh.h>

#include <deal.II/base/point.h>

#include <functional>
#include <vector>

namespace Morula
{
  /**
   * Reads the closed surface around cells from the file that a key names: STL,
   * OFF, PLY or OBJ (see SurfaceMesh). A cavity is a surface of its own.
   * @param cells their centres, µm
   * @throws InputError for a file that cannot be used, and where cells stand
   * outside of the surface, with their number
   */
  ClosedSurface<3>
  read_surface(const Key<std::string>      &file,
               const std::vector<Point<3>> &cells);

  /** Reads the surface of 2-D tissue: a POLYGON or MULTIPOLYGON of well-known
   *  text (WKT), which Boost.Geometry reads. */
  ClosedSurface<2>
  read_surface(const Key<std::string>      &file,
               const std::vector<Point<2>> &cells);

  /** Refuses the file if @p is_inside does not hold for all cells.
   *  @throws InputError with the number of those that stand outside */
  template <int dim>
  void
  refuse_outside(const Key<std::string>                        &file,
                 const std::vector<Point<dim>>                 &cells,
                 const std::function<bool(const Point<dim> &)> &is_inside);
} // namespace Morula

#endif
