// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_idle_rates_h
#define morula_scene_idle_rates_h

#include <morula/base/review.h>
#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  /** Warns of growth, death, cycles and changes that are asked for and happen
   *  to no founder in any step, as far as place and time alone tell.
   *  Collective. */
  template <int dim>
  void
  review_idle_rates(const Scene         &scene,
                    const Founders<dim> &founders,
                    const MPI_Comm       comm,
                    Review              &review);
} // namespace Morula

#endif
