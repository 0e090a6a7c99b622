// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_points_surface_h
#define morula_seeding_points_surface_h

#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <optional>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * Tiles a surface around cells from a file. It stands where the cells end:
   * where their volume, smoothed over 0.6 of a cell's length ℓ, falls to half
   * of what it is inside, moved by at most ℓ/4 along its normals so that it
   * encloses the sum of the cells' volumes. ℓ is that of the mean cell. Edges
   * are round. The patches are about as many as Boundary points says, or one
   * per ℓ² (2-D: ℓ), and their areas times normals add up to zero. Separate
   * bodies have surfaces of their own if an empty ball of half the width of
   * Closed gap passes between them, and so have cavities with room for one.
   * Where founders know their bodies, each body has a surface of its own. Rank
   * 0 makes the surface: it does not depend on the number of ranks. Where
   * Points surface names a file, the patches tile that surface. Collective.
   * @throws InputError if the surface encloses less than half or more than
   * twice the cells' volume, or leaves cells of the file outside
   */
  template <int dim>
  SurfacePatches<dim>
  seed_points_surface(const TissueParameters &parameters,
                      const Founders<dim>    &founders,
                      const MPI_Comm          comm);

  /** What a surface around cells shall be like. */
  struct SurfaceWish
  {
    /** Area of its patches, µm^(dim-1); 0: whoever makes it chooses. */
    double patch_area = 0.;
    /** ℓ, over which it is smooth, µm; 0: the length of the mean cell. */
    double length = 0.;
    /** The volume that the surface shall enclose exactly, µm^dim; 0: about the
     *  cells' volume. */
    double volume = 0.;
    /** Width of gaps and cavities that it closes, in ℓ. */
    double gap = 4.;
  };

  /**
   * The surface that seed_points_surface() makes, around cells at these
   * positions (µm) with these volumes (µm^dim).
   * @return nothing if the cells have no common surface: it would enclose less
   * than half or more than twice their volume, or have more parts than half the
   * cells
   */
  template <int dim>
  std::optional<SurfacePatches<dim>>
  surface_around(const std::vector<Point<dim>> &positions,
                 const std::vector<double>     &volumes,
                 const SurfaceWish             &wish);
} // namespace Morula

#endif
