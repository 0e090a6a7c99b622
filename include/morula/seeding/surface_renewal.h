// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_surface_renewal_h
#define morula_seeding_surface_renewal_h

#include <morula/particles/boundary_state.h>
#include <morula/particles/cells.h>
#include <morula/particles/point_list.h>

#include <mpi.h>

#include <optional>

namespace Morula
{
  /**
   * The boundary points of a surface that is made anew around the cells, as
   * around cells from a file: see surface_around(). Its patches are as large as
   * points shall be (BoundaryView::wanted_area()), have F = 1, and take over
   * from the nearest former point what holds or loads it, and the initial
   * positions by which that is asked. Held points (fixed, slip) stay as they
   * are, instead of the patches beside them. doc/theory.md, section 4.5. Rank 0
   * makes the surface: it does not depend on the number of ranks. Collective.
   *
   * @param cells   in their places
   * @param former  this rank's points before the step lost any
   * @param present this rank's points now
   * @param columns of boundary points, of a scene that coarsens the surface
   * @param longest_edge of a patch, µm
   * @param next_id is raised by the number of new points
   * @return the points, all of them on rank 0; nothing where the cells have no
   * common surface, or never had one
   */
  template <int dim>
  std::optional<PointList<dim>>
  renewed_surface(const Cells<dim>           &cells,
                  const PointList<dim>       &former,
                  const PointList<dim>       &present,
                  const BoundaryColumns<dim> &columns,
                  const double                longest_edge,
                  types::particle_index      &next_id,
                  const MPI_Comm              comm);
} // namespace Morula

#endif
