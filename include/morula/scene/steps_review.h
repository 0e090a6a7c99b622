// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_steps_review_h
#define morula_scene_steps_review_h

#include <morula/base/review.h>
#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  /** Warns of expressions of t which between two ends of steps leave the range
   *  of their values there, as pulses and waves faster than the steps do: the
   *  run does not see it. Collective. */
  template <int dim>
  void
  review_steps(const Scene               &scene,
               const Founders<dim>       &founders,
               const SurfacePatches<dim> &surface,
               const MPI_Comm             comm,
               Review                    &review);
} // namespace Morula

#endif
