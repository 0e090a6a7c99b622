// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_surface_mesh_h
#define morula_seeding_surface_mesh_h

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** A triangle with its neighbours' numbers across its edges. */
  struct SurfaceTriangle
  {
    /** Counter-clockwise when seen from outside, µm. */
    std::array<Point<3>, 3> vertices;
    /** Across the edge from vertices[i] to vertices[(i+1)%3]. */
    std::array<unsigned int, 3> neighbors;
  };

  /**
   * A closed surface of triangles read from a file, and the space inside it.
   * Everything that needs CGAL for it is behind this class.
   */
  class SurfaceMesh
  {
  public:
    /**
     * Reads STL, OFF, PLY or OBJ (by the name's ending), in µm. Coinciding
     * vertices are merged, polygons cut into triangles, and orientations made
     * outward; the surface of a cavity is turned towards the cavity.
     * @throws InputError if the file cannot be read or is cut off, or if the
     * surface is empty, open, non-manifold, has a triangle without area, or
     * intersects or touches itself; it says where
     */
    explicit SurfaceMesh(const std::string &file);

    ~SurfaceMesh();

    const std::vector<SurfaceTriangle> &
    triangles() const;

    BoundingBox<3>
    bounding_box() const;

    /** Whether @p x is inside, farther than @p clearance from the surface. */
    bool
    contains(const Point<3> &x, const double clearance) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation;
    std::vector<SurfaceTriangle>    all_triangles;
  };
} // namespace Morula

#endif
