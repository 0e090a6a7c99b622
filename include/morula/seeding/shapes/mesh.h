// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_shapes_mesh_h
#define morula_seeding_shapes_mesh_h

#include <morula/base/surface_mesh.h>
#include <morula/seeding/shape.h>

#include <string>

namespace Morula
{
  /** The body inside a closed surface that a file holds. It lies where the file
   *  places it. */
  class MeshShape : public Shape<3>
  {
  public:
    /** @throws InputError as SurfaceMesh */
    MeshShape(const std::string &key, const std::string &file);

    BoundingBox<3>
    bounding_box() const override
    {
      return mesh.bounding_box();
    }

    bool
    contains(const Point<3> &x, const double clearance) const override
    {
      return mesh.contains(x, clearance);
    }
    std::optional<bool>
    side_of_cube(const Point<3> &x, const double half_side) const override
    {
      return mesh.side_of_cube(x, half_side);
    }

    double
    volume() const override;

    double
    surface_area() const override;

    /** See cut_into_patches(). */
    SurfaceTiling<3>
    tile(const std::uint64_t n_wished) const override;

  private:
    SurfaceMesh mesh;
  };
} // namespace Morula

#endif
