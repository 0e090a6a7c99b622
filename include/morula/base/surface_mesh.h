// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_surface_mesh_h
#define morula_base_surface_mesh_h

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** A triangle of a surface and the numbers of its neighbours. */
  struct SurfaceTriangle
  {
    /** Counter-clockwise when seen from outside, µm. */
    std::array<Point<3>, 3> vertices;
    /** The neighbour across the edge from vertices[i] to vertices[(i+1)%3]. */
    std::array<unsigned int, 3> neighbors;
  };

  /** The point of a surface that is nearest to a place. */
  struct NearestPoint
  {
    /** Distance of the place, µm; negative inside. */
    double distance;
    /** Gradient of the distance: a unit vector along the line through the place
     *  and the nearest point, towards the outside. */
    Tensor<1, 3> direction;
    /** Second derivative of the distance, per µm: 0 if the nearest point is
     *  inside a triangle, not 0 if it is on an edge or a vertex. */
    Tensor<2, 3> curvature;
  };

  /**
   * A closed surface of triangles, read from a file, and the space inside it.
   * CGAL does the work, but does not appear in this interface.
   */
  class SurfaceMesh
  {
  public:
    /**
     * Reads STL, OFF, PLY or OBJ (by the file's ending), in µm. Coinciding
     * vertices are merged, if the surface is open otherwise also those that
     * differ by rounding to single precision, and polygons are cut into
     * triangles. Triangles are turned outward; those of a cavity are turned
     * towards the cavity.
     * @param key  path of the key that names the file
     * @throws InputError if the file cannot be read or is cut off, or if the
     * surface is empty, open or non-manifold, has a triangle without area, or
     * intersects or touches itself. The message says where.
     */
    SurfaceMesh(const std::string &key, const std::string &file);

    ~SurfaceMesh();

    const std::vector<SurfaceTriangle> &
    triangles() const
    {
      return all_triangles;
    }

    BoundingBox<3>
    bounding_box() const;

    /** Whether @p x is inside, and farther than @p clearance (µm) from the
     *  surface. */
    bool
    contains(const Point<3> &x, const double clearance) const;

    /** Whether a cube with the center @p x and this half side (µm) is inside,
     * or outside; nothing if the surface cuts it. */
    std::optional<bool>
    side_of_cube(const Point<3> &x, const double half_side) const;

    /** How far @p x (µm) is from the surface. */
    NearestPoint
    nearest(const Point<3> &x) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation;
    std::vector<SurfaceTriangle>    all_triangles;
  };

  /** The triangles of a file as above, whose surface may be open; a polygon is
   * a fan of them. @throws InputError if the file cannot be read or is cut off
   */
  std::vector<std::array<Point<3>, 3>>
  read_triangles(const std::string &key, const std::string &file);
} // namespace Morula

#endif
