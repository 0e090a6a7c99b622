// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_mesh_patches_h
#define morula_seeding_mesh_patches_h

#include <morula/base/surface_mesh.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <cstdint>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Outward unit normal of a triangle times its area, µm². */
  Tensor<1, 3>
  area_vector(const std::array<Point<3>, 3> &triangle);

  /**
   * Cuts a triangle into @p n_pieces triangles of equal area and appends them
   * to @p pieces. Each cut divides the longest edge as nearly in halves as the
   * number of pieces allows.
   */
  void
  cut_triangle(const std::array<Point<3>, 3>        &triangle,
               const std::uint64_t                   n_pieces,
               std::vector<std::array<Point<3>, 3>> &pieces);

  /**
   * Tiles a closed surface with about @p n_wished patches of about equal area.
   * Triangles larger than the mean patch are cut. Smaller ones are merged, the
   * smallest first, each into the neighbour whose centre is nearest, but never
   * across an edge sharper than 30 degrees. So more patches than wished may
   * remain. A patch has its triangles' mean normal. It lies at their common
   * centroid, moved onto the nearest of them and off its edges.
   * @param projected whether a patch's area is that along its mean normal, so
   * that areas times normals add up to zero; else it is that of the triangles,
   * and the areas add up to the surface's
   */
  std::vector<SurfacePatch<3>>
  cut_into_patches(const std::vector<SurfaceTriangle> &triangles,
                   const std::uint64_t                 n_wished,
                   const bool                          projected = false);
} // namespace Morula

#endif
