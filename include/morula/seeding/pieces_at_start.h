// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_pieces_at_start_h
#define morula_seeding_pieces_at_start_h

#include <morula/grid/grid_parameters.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
  /** To which piece of the tissue founders and patches of this rank belong at
   *  t = 0. A piece is a group of grid cells that touch and hold founders or
   *  boundary points; bodies that have contact are pieces of their own. */
  struct PiecesAtStart
  {
    /** Number of pieces, over all ranks. */
    unsigned int              n = 0;
    std::vector<unsigned int> of_founders, of_patches;
  };

  /** Finds the pieces, the same on all ranks. Collective. */
  template <int dim>
  PiecesAtStart
  pieces_at_start(const GridParameters      &grid,
                  const Founders<dim>       &founders,
                  const SurfacePatches<dim> &surface,
                  const MPI_Comm             comm);
} // namespace Morula

#endif
