// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_reviews_h
#define morula_seeding_reviews_h

#include <morula/base/review.h>
#include <morula/grid/grid_parameters.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
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
