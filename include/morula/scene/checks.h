// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_checks_h
#define morula_scene_checks_h

#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
  /**
   * Evaluates the scene's expressions at all founders at t = 0 and End time:
   * growth stretch and stiffness are positive, the cycle fits the step, body
   * forces are finite, some founder proliferates where there is a cell cycle;
   * and refuses a scene that does not fit into memory.
   * Collective; every rank gives its own founders, and all throw together.
   * @param founders initial positions, µm
   * @return number of founders, over all ranks, that proliferate
   * @throws InputError
   */
  template <int dim>
  types::particle_index
  check_at_cells(const Scene                   &scene,
                 const std::vector<Point<dim>> &founders,
                 const MPI_Comm                 comm);

  /** At how many boundary points each condition acts: fixed wins over slip,
   *  slip over traction and pressure. */
  struct ConditionCounts
  {
    types::particle_index points   = 0;
    types::particle_index fixed    = 0;
    types::particle_index slip     = 0;
    types::particle_index traction = 0;
    types::particle_index pressure = 0;
  };

  /**
   * Evaluates the boundary conditions at all boundary points at t = 0 and End
   * time, and the stiffness where points are fixed or slip. Refuses values
   * that are not finite and a condition that holds nowhere. Collective; every
   * rank gives its own points, and all throw together.
   * @return counts over all ranks
   * @throws InputError
   */
  template <int dim>
  ConditionCounts
  check_at_surface(const Scene               &scene,
                   const SurfacePatches<dim> &surface,
                   const MPI_Comm             comm);
} // namespace Morula

#endif
