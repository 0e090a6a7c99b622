// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_pieces_at_start_h
#define morula_seeding_pieces_at_start_h

#include <morula/base/review.h>
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


  /**
   * Warns of bodies that stick together from the start, because they are within
   * a grid spacing of each other. Only shapes that come from a file can be
   * several bodies. Collective.
   */
  template <int dim>
  void
  review_bodies(const GridParameters      &grid,
                const TissueParameters    &tissue,
                const Founders<dim>       &founders,
                const SurfacePatches<dim> &surface,
                const MPI_Comm             comm,
                Review                    &review);


  /**
   * Warns of a grid that does not suit the cells, the boundary points or the
   * body. Collective.
   * @param slips whether growing tissue slips along its surface
   */
  template <int dim>
  void
  review_grid(const GridParameters      &grid,
              const TissueParameters    &tissue,
              const Founders<dim>       &founders,
              const SurfacePatches<dim> &surface,
              const bool                 slips,
              const MPI_Comm             comm,
              Review                    &review);

  /**
   * Warns of cells whose length is that of another unit, and of a surface that
   * does not enclose the volume of its cells. Collective.
   */
  template <int dim>
  void
  review_units(const TissueParameters    &tissue,
               const Founders<dim>       &founders,
               const SurfacePatches<dim> &surface,
               const MPI_Comm             comm,
               Review                    &review);
} // namespace Morula

#endif
