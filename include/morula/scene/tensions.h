// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_tensions_h
#define morula_scene_tensions_h

#include <morula/base/review.h>
#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  /** The tensions of a scene's types of cells. @throws InputError if keys
   *  contradict each other */
  TypeTensions
  tensions_of(const Scene &scene);

  /** Warns of types whose domains are too narrow for their tension to be felt,
   *  as the founders stand. Collective. */
  template <int dim>
  void
  review_tensions(const Scene               &scene,
                  const Founders<dim>       &founders,
                  const SurfacePatches<dim> &surface,
                  const MPI_Comm             comm,
                  Review                    &review);
} // namespace Morula

#endif
