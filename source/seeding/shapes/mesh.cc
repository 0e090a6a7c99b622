// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/mesh_patches.h>
#include <morula/seeding/shapes/mesh.h>

#include <utility>

namespace Morula
{
  MeshShape::MeshShape(const std::string &key, const std::string &file)
    : mesh(key, file)
  {}

  double
  MeshShape::volume() const
  {
    // The volume is seen from a point of the surface, so that no digits are
    // lost if the body is far from the origin.
    const Point<3> apex   = mesh.triangles().front().vertices[0];
    double         volume = 0.;
    for (const SurfaceTriangle &triangle : mesh.triangles())
      volume += (triangle.vertices[0] - apex) * area_vector(triangle.vertices);
    return volume / 3.;
  }

  double
  MeshShape::surface_area() const
  {
    double area = 0.;
    for (const SurfaceTriangle &triangle : mesh.triangles())
      area += area_vector(triangle.vertices).norm();
    return area;
  }

  SurfaceTiling<3>
  MeshShape::tile(const std::uint64_t n_wished) const
  {
    SurfaceTiling<3>             tiling;
    std::vector<SurfacePatch<3>> patches =
      cut_into_patches(mesh.triangles(), n_wished);
    tiling.n_patches = patches.size();
    tiling.patch     = [patches = std::move(patches)](const std::uint64_t i) {
      return patches[i];
    };
    return tiling;
  }
} // namespace Morula
