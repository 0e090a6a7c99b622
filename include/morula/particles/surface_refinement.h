// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_surface_refinement_h
#define morula_particles_surface_refinement_h

#include <morula/particles/boundary_state.h>
#include <morula/particles/point_list.h>

#include <mpi.h>

#include <functional>
#include <stdexcept>
#include <vector>

namespace Morula
{
  /** A boundary point was carried away so far that its patch cannot be split.
   */
  class SurfaceTorn : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /**
   * Splits every boundary point whose patch has an edge F E, doc/theory.md
   * (4.11), longer than @p longest_edge (µm) in two along its longest edge,
   * until none is left. Each new point takes half of the area and sits in the
   * middle of its half, X ∓ E/4 and x ∓ F E/4, with the same N, F and
   * condition: doc/theory.md (4.12). If the surface is coarsened, points with
   * more than twice the area of (4.12b) are split, too. Σ a n, Σ a n·x and Σ a⁰
   * do not change, and points move only tangentially.
   *
   * The point on the -E side keeps its id, the other one gets a new id. The new
   * ids of one round of splitting are in the order of the split points' ids,
   * for any number of ranks.
   *
   * Points where the surface is crowded are not split: there the surface is
   * crumpled, and further points would be carried apart, too, ever more of
   * them.
   *
   * @param points  this rank's boundary points
   * @param columns of the points, with patches
   * @param crowded whether there are enough points around a place already
   * @param next_id first free id, the same on all ranks; advanced
   * @return whether any rank has split a point. Collective.
   * @throws SurfaceTorn on all ranks, before anything is split, if an edge that
   *         is to be split is longer than 64 @p longest_edge
   */
  template <int dim>
  bool
  refine_surface(PointList<dim>                                &points,
                 const BoundaryColumns<dim>                    &columns,
                 const double                                   longest_edge,
                 const std::function<bool(const Point<dim> &)> &crowded,
                 types::particle_index                         &next_id,
                 const MPI_Comm                                 comm);
} // namespace Morula

#endif
