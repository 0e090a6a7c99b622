// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef half_fixed_sphere_mesh_h
#define half_fixed_sphere_mesh_h

#include <deal.II/grid/tria.h>

namespace HalfFixedSphere
{
  using namespace dealii;

  /** Boundary ids of the half disc. */
  enum BoundaryId : types::boundary_id
  {
    axis          = 0,
    lower_surface = 1,
    upper_surface = 2
  };

  /** Material ids: the grid cells next to the edge, and all others. */
  enum MaterialId : types::material_id
  {
    elsewhere = 0,
    near_edge = 1
  };

  /** How the half disc is meshed. */
  struct MeshSize
  {
    unsigned int subdivisions;   // grid cells along 45 degrees of the surface
    unsigned int edge_levels;    // bisections of the grid cells at the edge
    unsigned int uniform_levels; // bisections of all grid cells after that
  };

  /** Length of the grid cells at the edge, um. */
  double
  innermost_size(const double radius, const MeshSize &size);

  /**
   * The meridian section r >= 0 of a sphere, points (r, z) in um. A vertex
   * stands where the surface crosses z = @p edge; grid cells touching it are
   * bisected again and again.
   */
  void
  make_half_disc(const double      radius,
                 const double      edge,
                 const MeshSize   &size,
                 Triangulation<2> &mesh);
} // namespace HalfFixedSphere

#endif
