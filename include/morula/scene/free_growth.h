// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_free_growth_h
#define morula_scene_free_growth_h

#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <optional>

namespace Morula
{
  /**
   * By which factor a growth law that depends on the cells' state makes the
   * founders larger until End time, on average, if nothing presses them: each
   * grows free of stress where it stands, of the type that it has, in the
   * fields of t = 0. Nothing for other laws, which GrowthLaw's
   * expected_volume_ratio() tells of. Where there are many founders, only some
   * are asked. Collective.
   */
  template <int dim>
  std::optional<double>
  free_growth(const Scene               &scene,
              const Founders<dim>       &founders,
              const SurfacePatches<dim> &surface,
              const MPI_Comm             comm);
} // namespace Morula

#endif
