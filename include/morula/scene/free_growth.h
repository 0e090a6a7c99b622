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
  /** The factors by which growth makes the volumes of founders larger. */
  struct FreeGrowth
  {
    double mean = 1., least = 1., most = 1.;
    /** Cells that descend from a founder, on average, where cells divide when
     *  they have grown; else 0. */
    double cells = 0.;
    /** Whether place and time alone tell growth, so that GrowthLaw's
     *  expected_volume_ratio() has it, too. */
    bool known_before = true;
  };

  /**
   * The factors by which a growth law makes the founders larger until End time,
   * if nothing presses them: each grows free of stress where it stands, of the
   * type that it has, in the fields of t = 0. Nothing without a law. Where
   * there are many founders, only some are asked. Collective.
   */
  template <int dim>
  std::optional<FreeGrowth>
  free_growth(const Scene               &scene,
              const Founders<dim>       &founders,
              const SurfacePatches<dim> &surface,
              const MPI_Comm             comm);
} // namespace Morula

#endif
