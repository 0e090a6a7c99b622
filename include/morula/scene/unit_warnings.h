// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_unit_warnings_h
#define morula_scene_unit_warnings_h

#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace Morula
{
  /**
   * The part of scene_warnings() that asks whether the file of a tissue is in
   * um: points whose nearest neighbours are nearer or farther than cells are
   * long, and meshes of few cells. Collective.
   */
  template <int dim>
  std::vector<std::string>
  unit_warnings(const Scene         &scene,
                const Founders<dim> &founders,
                const MPI_Comm       comm);
} // namespace Morula

#endif
