// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_surface_surface_from_cells_h
#define morula_surface_surface_from_cells_h

#include <morula/particles/tissue.h>
#include <morula/surface/walls.h>

#include <optional>

namespace Morula
{
  /** What the boundary points of a body shall be when they are made from its
   *  cells. */
  template <int dim>
  struct SurfaceWish
  {
    unsigned int body;
    /** Of the cells' volume, that the surface encloses. */
    double share;
    /** This rank's points of the body before the step: a new patch takes over
     *  what it knows from the nearest one of its side. */
    PointList<dim> former;
    /** How far a former point may be, µm. */
    double reach;
    /** This rank's points of the body now, if the surface is tracked: they stay
     *  if no patch has a lost one for its nearest former point, as where a
     *  piece has gone as a whole. New patches remember by how much the area has
     *  grown since t = 0. */
    std::optional<PointList<dim>> present;
    /** Walls of t = 0 on which new patches stand, or null. */
    const Walls<dim> *walls;
    /** What a patch is that has no former point on its side. */
    PlaceConditions<dim> scene;
  };

  /**
   * The boundary points of a body, made from its cells: see
   * surface_of_cells() and doc/theory.md, section 4.5. Patches at a wall stand
   * on it. Of the others each takes over the condition, the initial position
   * and the state of the nearest former point of its side, and begins anew
   * as doc/theory.md (4.12e) says, with F = 1. Together they are closed and
   * enclose the wished share of the cells' volume. The same on any number of
   * ranks. Collective.
   * @param next_id is raised by the number of new points
   */
  template <int dim>
  PointList<dim>
  surface_from_cells(const Tissue<dim>      &tissue,
                     const SurfaceWish<dim> &wish,
                     types::particle_index  &next_id);
} // namespace Morula

#endif
