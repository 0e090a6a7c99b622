// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_size_h
#define morula_scene_size_h

#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  /** The size of a scene at t = 0. */
  struct SceneSize
  {
    double cells  = 0.;
    double volume = 0.; // µm^dim
    // of the box around the tissue; 0: not known (few for compact tissue)
    double grid_cells = 0.;
  };

  /**
   * Size at t = 0 from the shape and the cell spacing, before anything is
   * seeded; 0 for shapes from files, whose size is not known yet.
   */
  SceneSize
  initial_size(const Scene &scene);

  /** Physical memory of all machines that run ranks, bytes. Collective. */
  double
  physical_memory(const MPI_Comm comm);

  /**
   * Refuses a scene that does not fit into memory. Collective.
   * @throws InputError
   */
  void
  check_memory(const Scene &scene, const SceneSize &size, const MPI_Comm comm);

  /** The limits of the scene's tissue, if it comes from a file, and the names
   * of its cells' types. */
  template <int dim>
  SeedingLimits<dim>
  seeding_limits(const Scene &scene, const MPI_Comm comm);
} // namespace Morula

#endif
