// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_idle_keys_h
#define morula_scene_idle_keys_h

#include <morula/base/review.h>
#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  /** Warns of times, types and columns of a points file with which values do
   *  nothing. Collective. */
  template <int dim>
  void
  review_idle_keys(const Scene         &scene,
                   const Founders<dim> &founders,
                   const MPI_Comm       comm,
                   Review              &review);
} // namespace Morula

#endif
