// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_state_surface_distance_h
#define morula_effects_state_surface_distance_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
  using namespace dealii;

  /** The surface near a place. */
  template <int dim>
  struct NearSurface
  {
    /** Distance from the plane of the nearest boundary point, µm; 0 outside. */
    double depth = 0.;
    /** Outward unit normal there. */
    Tensor<1, dim> normal;
  };

  /**
   * The surface near each place, at t = 0, over all ranks' boundary points.
   * Without boundary points the surface is infinitely far. Collective.
   * @param places  µm
   * @param points  positions of this rank's boundary points, µm
   * @param normals their outward unit normals
   */
  template <int dim>
  std::vector<NearSurface<dim>>
  near_surface(const std::vector<Point<dim>>     &places,
               const std::vector<Point<dim>>     &points,
               const std::vector<Tensor<1, dim>> &normals,
               const MPI_Comm                     comm);
} // namespace Morula

#endif
