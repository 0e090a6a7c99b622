// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_warnings_h
#define morula_scene_warnings_h

#include <morula/scene/checks.h>
#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace Morula
{
  /**
   * What is legal in a scene but unwise: each a line with key, value, what was
   * measured and where, and what to do. A warning needs a measurement in doc/,
   * or must follow from what the keys say. Empty for a scene in order.
   * Collective; the same on all ranks, every rank gives its own founders and
   * boundary points of a scene that has passed all checks.
   * @param counts what check_at_surface() has returned
   */
  template <int dim>
  std::vector<std::string>
  scene_warnings(const Scene               &scene,
                 const Founders<dim>       &founders,
                 const SurfacePatches<dim> &surface,
                 const ConditionCounts     &counts,
                 const MPI_Comm             comm);
} // namespace Morula

#endif
