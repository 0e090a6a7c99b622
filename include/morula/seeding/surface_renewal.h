// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_surface_renewal_h
#define morula_seeding_surface_renewal_h

#include <morula/particles/boundary_state.h>
#include <morula/particles/point_list.h>
#include <morula/particles/tissue.h>
#include <morula/seeding/points_surface.h>

#include <mpi.h>

#include <functional>
#include <optional>

namespace Morula
{
  /**
   * The boundary points of a surface that is made anew around the cells, as
   * around cells from a file: see surface_around(). Its patches have the area
   * that points shall have (BoundaryView::wanted_area()) and F = 1. Each takes
   * over the conditions of the nearest former point, and the initial position
   * for which these are evaluated. Held points (fixed, slip) stay as they are
   * and replace the patches beside them. doc/theory.md, section 4.5. Rank 0
   * makes the surface: it does not depend on the number of ranks. Collective.
   *
   * @param cells   in their places
   * @param former  this rank's points before the step lost any
   * @param present this rank's points now
   * @param columns of the boundary points
   * @param wish    how smooth it shall be, and what it shall enclose; without a
   *        patch area that of wanted_area()
   * @param longest_edge of a patch, µm
   * @param next_id is raised by the number of new points
   * @param body the surface is made around the cells of this body alone, if
   *        given; @p former and @p present are its points then
   * @param keeps_gaps whether points that face others across a gap which a new
   *        surface would close stay where they are, with F = 1: the sides of a
   *        fold
   * @return the points, all of them on rank 0; nothing if the cells have no
   * common surface, or never had one
   */
  template <int dim>
  std::optional<PointList<dim>>
  renewed_surface(const Cells<dim>                  &cells,
                  const PointList<dim>              &former,
                  const PointList<dim>              &present,
                  const BoundaryColumns<dim>        &columns,
                  const SurfaceWish                 &wish,
                  const double                       longest_edge,
                  types::particle_index             &next_id,
                  const MPI_Comm                     comm,
                  const std::optional<unsigned int> &body       = {},
                  const bool                         keeps_gaps = false);

  /**
   * The boundary points of a tissue that was carved at t = 0: the present ones
   * stay, and where the tissue was cut patches of the same area stand around
   * its cells, see surface_around(). Their areas are corrected, in proportion,
   * so that Σ a n = 0 over all points. Rank 0 makes them. Collective.
   * @param condition what holds or loads a point of t = 0 at this place (µm)
   *        with this outward unit normal
   * @param next_id is raised by the number of new points
   * @param body the cells are those of this body alone, if given, and so are
   * the
   *        @p present points
   * @return all points, on rank 0; nothing if the cells have no common surface
   */
  template <int dim>
  std::optional<PointList<dim>>
  carved_surface(const Cells<dim>                               &cells,
                 const PointList<dim>                           &present,
                 const BoundaryColumns<dim>                     &columns,
                 const std::function<SurfaceCondition(
                   const Point<dim> &, const Tensor<1, dim> &)> &condition,
                 types::particle_index                          &next_id,
                 const MPI_Comm                                  comm,
                 const std::optional<unsigned int>              &body = {});
} // namespace Morula

#endif
