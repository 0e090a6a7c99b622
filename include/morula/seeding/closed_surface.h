// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_closed_surface_h
#define morula_seeding_closed_surface_h

#include <deal.II/base/point.h>

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  template <typename T>
  class Key;
  template <int dim>
  struct AllCells;
  template <int dim>
  struct SurfacePatches;

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

  /** Area of all facets, µm^(dim-1). */
  template <int dim>
  double
  total_area(const ClosedSurface<dim> &surface);

  /**
   * A surface where the cells end, with gaps narrower than @p gap lengths
   * closed.
   * @param misfit why it is not one around all cells, with a full stop, rather
   *        than around each; empty if it is
   */
  template <int dim>
  ClosedSurface<dim>
  enclose(const AllCells<dim> &cells, const double gap, std::string &misfit);

  /** The surface in about so many patches. */
  template <int dim>
  SurfacePatches<dim>
  tiled(const ClosedSurface<dim> &surface, const double n_wished);

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

  /** The straight parts of the lines of well-known text (WKT) in a file, in µm.
   *  @throws InputError if the text is none */
  std::vector<std::array<Point<2>, 2>>
  read_segments(const Key<std::string> &file);
} // namespace Morula

#endif
