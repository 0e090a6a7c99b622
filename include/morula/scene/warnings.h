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
   * Warnings of what is legal in a scene but unwise. Each is a line with key,
   * value, what was measured and where, and what to do. A warning needs a
   * measurement in doc/, or must follow from what the keys say. Empty if there
   * is nothing to warn of. Collective: the scene has passed all checks, every
   * rank gives its own founders and boundary points, and all get the same
   * warnings.
   * @param counts what check_at_surface() has returned
   */
  template <int dim>
  std::vector<std::string>
  scene_warnings(const TissueModel<dim>    &model,
                 const Founders<dim>       &founders,
                 const SurfacePatches<dim> &surface,
                 const ConditionCounts     &counts,
                 const MPI_Comm             comm);
} // namespace Morula

#endif
