// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/surface_mesh.h>
#include <morula/base/surface_mesh_soup.h>

#include <deal.II/base/symmetric_tensor.h>

#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace Morula
{

  namespace
  {
    namespace Processing = CGAL::Polygon_mesh_processing;

    using Kernel = MeshSoup::Kernel;
    using Mesh   = CGAL::Surface_mesh<Kernel::Point_3>;
    using Inside = CGAL::Side_of_triangle_mesh<Mesh, Kernel>;
    using Tree   = Inside::AABB_tree;

    /** Refuses a surface with an edge that does not have two polygons. */
    void
    check_edges(const MeshSoup &soup)
    {
      const auto edges = soup.edges();
      for (const bool many : {true, false})
        for (const auto &[edge, n_polygons] : edges)
          if (many ? n_polygons > 2 : n_polygons < 2)
            soup.refuse(
              "The surface is " + std::string(many ? "non-manifold" : "open") +
              ": the edge from " + place(soup.points[edge.first]) + " to " +
              place(soup.points[edge.second]) + " um belongs to " +
              std::to_string(n_polygons) +
              " polygons. Close holes, merge vertices that should coincide, remove "
              "inner walls and fins, and separate bodies that touch.");
    }

    std::string
    corners(const Mesh &mesh, const Mesh::Face_index face)
    {
      std::string text;
      for (const Mesh::Vertex_index v :
           CGAL::vertices_around_face(mesh.halfedge(face), mesh))
        text += (text.empty() ? "" : ", ") + place(mesh.point(v));
      return text + " um";
    }

    /** Refuses a triangle so thin that rounding would spoil its normal. */
    void
    check_areas(const Mesh &mesh, const MeshSoup &soup)
    {
      // Below this, rounding of the corners decides about the normal.
      constexpr double smallest = 1e-14; // of the longest edge's square
      for (const Mesh::Face_index face : mesh.faces())
        {
          double longest = 0.;
          for (const Mesh::Halfedge_index edge :
               CGAL::halfedges_around_face(mesh.halfedge(face), mesh))
            longest = std::max(longest,
                               CGAL::to_double(CGAL::squared_distance(
                                 mesh.point(mesh.source(edge)),
                                 mesh.point(mesh.target(edge)))));
          if (!(Processing::face_area(face, mesh) > smallest * longest))
            soup.refuse(
              "The triangle with the corners " + corners(mesh, face) +
              " has no area: remove such triangles with a mesh editor, "
              "or export the surface again.");
        }
    }

    /** Refuses triangles that cross or touch other ones than their neighbours.
     */
    void
    check_intersections(const Mesh &mesh, const MeshSoup &soup)
    {
      std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
      Processing::self_intersections(mesh, std::back_inserter(pairs));
      if (pairs.empty())
        return;
      // The smallest pair is the same in each run, whatever order CGAL finds
      // them in.
      const auto [one, other] = *std::min_element(pairs.begin(), pairs.end());
      soup.refuse("The surface intersects or touches itself: " +
                  std::to_string(pairs.size()) +
                  " pairs of triangles meet, such as those with the corners " +
                  corners(mesh, one) + " and " + corners(mesh, other) +
                  ". Repair it with a mesh editor.");
    }

    Mesh
    read_mesh(const std::string &key, const std::string &file)
    {
      // From what a file holds to a surface that bounds a volume. Each step is
      // possible only after the one before: edges are counted in the soup, so
      // that faults can be named; polygons are turned alike and become a mesh;
      // a closed mesh of triangles is tested for flat and crossing ones; at
      // last the normals are turned outward, also those of cavities.
      MeshSoup soup(key, file);
      check_edges(soup);
      Processing::orient_polygon_soup(soup.points, soup.polygons);
      if (!Processing::is_polygon_soup_a_polygon_mesh(soup.polygons))
        soup.refuse("The surface is non-manifold: repair it.");

      Mesh mesh;
      Processing::polygon_soup_to_polygon_mesh(soup.points,
                                               soup.polygons,
                                               mesh);
      if (!CGAL::is_closed(mesh))
        soup.refuse("The surface has no inside: repair its orientation.");
      if (!Processing::triangulate_faces(mesh))
        soup.refuse(
          "Some polygons cannot be cut into triangles: export the surface "
          "as triangles.");
      check_areas(mesh, soup);
      check_intersections(mesh, soup);
      Processing::orient_to_bound_a_volume(mesh);
      // Numbers of faces have to be without gaps, as they are used as indices.
      mesh.collect_garbage();
      return mesh;
    }

    Point<3>
    point(const Kernel::Point_3 &p)
    {
      return {p.x(), p.y(), p.z()};
    }

    /** The edge from vertex i to the next one. */
    Tensor<1, 3>
    edge(const SurfaceTriangle &triangle, const unsigned int i)
    {
      return triangle.vertices[(i + 1) % 3] - triangle.vertices[i];
    }

    /** Outward unit normal. */
    Tensor<1, 3>
    normal(const SurfaceTriangle &triangle)
    {
      const Tensor<1, 3> twice_area =
        cross_product_3d(edge(triangle, 0), edge(triangle, 1));
      return twice_area / twice_area.norm();
    }

    /** Projection onto the directions across the edge that @p x lies on; the
     *  identity if it is a vertex. */
    Tensor<2, 3>
    directions_across(const SurfaceTriangle &triangle, const Point<3> &x)
    {
      const Tensor<2, 3> identity(unit_symmetric_tensor<3>());
      unsigned int       nearest = 0;
      double             least   = std::numeric_limits<double>::infinity();
      // The place is on the boundary of the triangle: a vertex if it is near
      // one, else on the edge that it is nearest to.
      for (unsigned int i = 0; i < 3; ++i)
        {
          const Tensor<1, 3> along = edge(triangle, i);
          const Tensor<1, 3> way   = x - triangle.vertices[i];
          if (way.norm() < 1e-9 * along.norm())
            return identity;
          const double distance =
            cross_product_3d(along, way).norm() / along.norm();
          if (distance < least)
            {
              least   = distance;
              nearest = i;
            }
        }
      const Tensor<1, 3> along = edge(triangle, nearest);
      return identity - outer_product(along, along) / along.norm_square();
    }
  } // namespace

  // CGAL is kept out of the header, since it takes long to compile. The order
  // of members counts: the tree refers to the mesh, and the test for inside to
  // the tree.
  struct SurfaceMesh::Implementation
  {
    Implementation(const std::string &key, const std::string &file)
      : mesh(read_mesh(key, file))
      , tree(mesh.faces().begin(), mesh.faces().end(), mesh)
      , inside(tree)
    {}

    const Mesh   mesh;
    const Tree   tree;
    const Inside inside;
  };

  SurfaceMesh::SurfaceMesh(const std::string &key, const std::string &file)
    : implementation(std::make_unique<Implementation>(key, file))
  {
    const Mesh &mesh = implementation->mesh;
    all_triangles.reserve(mesh.number_of_faces());
    for (const Mesh::Face_index face : mesh.faces())
      {
        SurfaceTriangle      triangle;
        Mesh::Halfedge_index edge = mesh.halfedge(face);
        for (unsigned int i = 0; i < 3; ++i, edge = mesh.next(edge))
          {
            triangle.vertices[i]  = point(mesh.point(mesh.source(edge)));
            triangle.neighbors[i] = mesh.face(mesh.opposite(edge));
          }
        all_triangles.push_back(triangle);
      }
  }

  SurfaceMesh::~SurfaceMesh() = default;

  BoundingBox<3>
  SurfaceMesh::bounding_box() const
  {
    const CGAL::Bbox_3 box = implementation->tree.bbox();
    return BoundingBox<3>({Point<3>(box.xmin(), box.ymin(), box.zmin()),
                           Point<3>(box.xmax(), box.ymax(), box.zmax())});
  }

  bool
  SurfaceMesh::contains(const Point<3> &x, const double clearance) const
  {
    const Kernel::Point_3 p(x[0], x[1], x[2]);
    // A place is inside if it is so and no triangle is nearer than the
    // clearance.
    return implementation->inside(p) == CGAL::ON_BOUNDED_SIDE &&
           !implementation->tree.do_intersect(
             Kernel::Sphere_3(p, clearance * clearance));
  }

  std::optional<bool>
  SurfaceMesh::side_of_cube(const Point<3> &x, const double half_side) const
  {
    const double          s = half_side;
    const Kernel::Point_3 p(x[0], x[1], x[2]),
      lower(x[0] - s, x[1] - s, x[2] - s), upper(x[0] + s, x[1] + s, x[2] + s);
    if (implementation->tree.do_intersect(Kernel::Iso_cuboid_3(lower, upper)))
      return {};
    return implementation->inside(p) == CGAL::ON_BOUNDED_SIDE;
  }

  NearestPoint
  SurfaceMesh::nearest(const Point<3> &x) const
  {
    const Kernel::Point_3 p(x[0], x[1], x[2]);
    const auto [closest, face] =
      implementation->tree.closest_point_and_primitive(p);
    const SurfaceTriangle &triangle = all_triangles[face];
    const Tensor<1, 3>     way      = x - point(closest);
    const Tensor<1, 3>     n        = normal(triangle);
    const double           length   = way.norm();
    // The place is straight above or below a triangle, or so near to the
    // surface that rounding decides where. There the distance is linear, and
    // its direction is the normal.
    if (length < 1e-7 * edge(triangle, 0).norm() + 1e-9 * x.norm() ||
        cross_product_3d(way, n).norm() < 1e-6 * length)
      return {way * n, n, Tensor<2, 3>()};
    // Beside an edge or a vertex the distance curves: its second derivative is
    // (P - n n)/distance, with the projection P onto the directions across.
    const bool   is_inside = implementation->inside(p) == CGAL::ON_BOUNDED_SIDE;
    const double distance  = is_inside ? -length : length;
    const Tensor<1, 3> direction = way / distance;
    const Tensor<2, 3> across    = directions_across(triangle, point(closest));
    return {distance,
            direction,
            (across - outer_product(direction, direction)) / distance};
  }
} // namespace Morula
