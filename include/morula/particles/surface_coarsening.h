// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_surface_coarsening_h
#define morula_particles_surface_coarsening_h

#include <morula/particles/boundary_state.h>
#include <morula/particles/point_list.h>

#include <mpi.h>

#include <functional>

namespace Morula
{
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
