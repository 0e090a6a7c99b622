// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_surface_refinement_h
#define morula_particles_surface_refinement_h

#include <morula/particles/boundary_state.h>
#include <morula/particles/point_list.h>

#include <mpi.h>

#include <functional>
#include <vector>

namespace Morula
{
  /** Whether a patch of any rank that is to be split has an edge that is longer
   *  than 64 @p longest_edge (µm): its point was carried away from the tissue.
   *  Arguments as of refine_surface(). Collective. */
  template <int dim>
  bool
  has_torn_patch(const PointList<dim>                          &points,
                 const BoundaryColumns<dim>                    &columns,
                 const double                                   longest_edge,
                 const std::function<bool(const Point<dim> &)> &crowded,
                 const MPI_Comm                                 comm);

  /**
   * Splits every boundary point whose patch has an edge F E, doc/theory.md
   * (4.11), longer than @p longest_edge (µm) in two along its longest edge,
   * until none is left. Each new point takes half of the area and sits in the
   * middle of its half, with the same N and condition: doc/theory.md (4.12).
   * On a curved surface the halves are bent as it is: (4.12a). If the surface
   * is coarsened, points with more than twice the area of (4.12b) are split,
   * too. Σ a n, Σ a n·x and Σ a⁰ do not change.
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
   */
  template <int dim>
  bool
  refine_surface(PointList<dim>                                &points,
                 const BoundaryColumns<dim>                    &columns,
                 const double                                   longest_edge,
                 const std::function<bool(const Point<dim> &)> &crowded,
                 types::particle_index                         &next_id,
                 const MPI_Comm                                 comm);


  /**
   * Merges boundary points whose patches have shrunk to less than half of the
   * area that they shall have, doc/theory.md (4.12b). Each merges with the
   * nearest point that is alike, until nothing is left to merge: doc/theory.md
   * (4.12c), (4.12d). Σ a n and Σ a n·x do not change. A merged patch is no
   * larger than 1.6 times its reference area, and square. It has the condition
   * of both, and the smaller id.
   *
   * All ranks look at all patches that may merge, and so find the same pairs,
   * for any number of ranks. In most steps there are none, and a surface has
   * few points compared with the cells.
   *
   * @param points       this rank's boundary points
   * @param columns      of these, with patches and reference areas
   * @param longest_edge beyond which patches are split, µm
   * @param alike        whether the same loads act on two points of the same
   *                     condition
   * @return whether any were merged. Collective.
   */
  template <int dim>
  bool
  coarsen_surface(PointList<dim>             &points,
                  const BoundaryColumns<dim> &columns,
                  const double                longest_edge,
                  const std::function<bool(const BoundaryView<dim> &,
                                           const BoundaryView<dim> &)> &alike,
                  const MPI_Comm                                        comm);
} // namespace Morula

#endif
