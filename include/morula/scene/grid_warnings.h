// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_grid_warnings_h
#define morula_scene_grid_warnings_h

#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  /**
   * The part of scene_warnings() that looks at the grid next to the cells, the
   * boundary points and the body. Collective.
   */
  template <int dim>
  void
  review_grid(const Scene               &scene,
              const Founders<dim>       &founders,
              const SurfacePatches<dim> &surface,
              const MPI_Comm             comm,
              Review                    &review);
} // namespace Morula

#endif
