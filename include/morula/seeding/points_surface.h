// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_points_surface_h
#define morula_seeding_points_surface_h

#include <morula/grid/grid_parameters.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  using namespace dealii;

  /**
   * Tiles a surface around cells from a file: that of surface_of_cells(), which
   * encloses the sum of their volumes. The patches are those of the lattice of
   * the scene's grid, or of a finer or coarser one on which they are about as
   * many as Boundary points says. Where founders know their bodies, each body
   * has a surface of its own, see part_bodies(). Where Points surface names a
   * file, the patches tile that surface. The same to the bit on any number of
   * ranks. Collective.
   * @throws InputError if there is no surface around all cells, or if that of
   * the file leaves cells outside
   */
  template <int dim>
  SurfacePatches<dim>
  seed_points_surface(const TissueParameters &parameters,
                      const GridParameters   &grid,
                      const Founders<dim>    &founders,
                      const MPI_Comm          comm);
} // namespace Morula

#endif
