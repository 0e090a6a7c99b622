// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_limits_h
#define morula_scene_limits_h

#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <mpi.h>

namespace Morula
{
  /** Farther from the origin, in units of h, there are no grid cells: they are
   *  counted by integers, and positions lose their digits. */
  constexpr double farthest_place = 1e8;

  /** Longest tissue along an axis, in units of h. A box of so many grid cells
   *  in all directions is more than any machine holds; along one direction it
   *  is some metres of tissue, and nearly always one point that lies astray. */
  constexpr double longest_tissue = 1000.;

  /** Longest cell, in units of h: it deforms as a whole, and takes the power
   *  dim of this number of quadrature points. */
  constexpr double longest_cell = 10.;

  /**
   * Refuses shapes and cells whose lengths, as the scene gives them, are beyond
   * these limits.
   * @throws InputError
   */
  void
  check_lengths(const Scene &scene);

  /** The limits for tissue from files, with the memory of these machines. */
  template <int dim>
  SeedingLimits<dim>
  seeding_limits(const Scene &scene, const MPI_Comm comm);
} // namespace Morula

#endif
