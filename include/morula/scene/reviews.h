// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_reviews_h
#define morula_scene_reviews_h

#include <morula/base/review.h>
#include <morula/scene/tissue_model.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  /** Warns of values that the scene sets and nothing reads, as the keys alone
   *  tell: of effects that it switches off, and of keys that only some scenes
   *  read. Values of an effect whose switch it does not set are refused. */
  void
  review_idle_effects(const Scene &scene, Review &review);

  /**
   * Warns of rates of death and of leaving a type that are fast for the step.
   * Such a rate is taken for the cell's state at the beginning of a step, so
   * what other cells become in the step is not felt: an error of first order in
   * rate times step. Rates that no other cell can change are taken in the
   * middle of the step, of second order, and not looked at. Collective.
   * @throws InputError on all ranks where a rate has no value
   */
  template <int dim>
  void
  review_rates(const TissueModel<dim>    &model,
               const Founders<dim>       &founders,
               const SurfacePatches<dim> &surface,
               const MPI_Comm             comm,
               Review                    &review);

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
