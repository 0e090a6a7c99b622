// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_far_obstacles_h
#define morula_scene_far_obstacles_h

#include <morula/base/review.h>
#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  /** Warns of obstacles that stand farther from the tissue than the tissue is
   *  long, and do not come nearer until the end. Collective. */
  template <int dim>
  void
  review_far_obstacles(const Scene               &scene,
                       const SurfacePatches<dim> &surface,
                       const MPI_Comm             comm,
                       Review                    &review);
} // namespace Morula

#endif
