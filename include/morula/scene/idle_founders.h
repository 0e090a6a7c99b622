// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_idle_founders_h
#define morula_scene_idle_founders_h

#include <morula/base/review.h>
#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  /** Warns of columns of a points file that nothing reads in the scene, and of
   *  keys that stand back behind what the file says or need a surface that is
   *  not there. Collective. */
  template <int dim>
  void
  review_idle_founders(const Scene         &scene,
                       const Founders<dim> &founders,
                       const MPI_Comm       comm,
                       Review              &review);
} // namespace Morula

#endif
