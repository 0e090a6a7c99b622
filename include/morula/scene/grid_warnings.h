// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_grid_warnings_h
#define morula_scene_grid_warnings_h

#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace Morula
{
  /**
   * A warning as a line.
   * @param key    full path
   * @param value  with its unit
   * @param why    what goes wrong, and where that was measured
   * @param remedy what to do, a full sentence
   */
  std::string
  warning(const std::string &key,
          const std::string &value,
          const std::string &why,
          const std::string &remedy);

  /**
   * The part of scene_warnings() that looks at the grid next to the cells, the
   * boundary points and the body. Collective.
   */
  template <int dim>
  std::vector<std::string>
  grid_warnings(const Scene               &scene,
                const Founders<dim>       &founders,
                const SurfacePatches<dim> &surface,
                const MPI_Comm             comm);
} // namespace Morula

#endif
