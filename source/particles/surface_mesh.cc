// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/input_error.h>
#include <morula/particles/surface_mesh.h>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace Morula
{
  namespace
  {
    namespace Processing = CGAL::Polygon_mesh_processing;

    using Kernel    = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Mesh      = CGAL::Surface_mesh<Kernel::Point_3>;
    using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
    using Tree      = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
    using Inside    = CGAL::Side_of_triangle_mesh<Mesh, Kernel>;

    /** Polygons as files have them: with no order among each other. */
    struct Soup
    {
      std::vector<Kernel::Point_3>          points;
      std::vector<std::vector<std::size_t>> polygons;
    };

    [[noreturn]] void
    refuse(const std::string &file, const std::string &remedy)
    {
      throw InputError("Tissue/Surface mesh",
                       file,
                       "a closed surface that does not intersect itself, as an "
                       "STL, OFF, PLY or OBJ file",
                       remedy);
    }

    Soup
    read_soup(const std::string &file)
    {
      Soup soup;
      bool good = false;
      try
        {
          good = CGAL::IO::read_polygon_soup(file, soup.points, soup.polygons);
        }
      catch (const std::exception &)
        {
          // what it could not parse is reported below
        }
      const auto in_range = [&](const std::vector<std::size_t> &polygon) {
        return std::all_of(polygon.begin(),
                           polygon.end(),
                           [&](const std::size_t i) {
                             return i < soup.points.size();
                           });
      };
      const auto finite = [](const Kernel::Point_3 &p) {
        return std::isfinite(p.x()) && std::isfinite(p.y()) &&
               std::isfinite(p.z());
      };
      if (!good ||
          !std::all_of(soup.polygons.begin(), soup.polygons.end(), in_range) ||
          !std::all_of(soup.points.begin(), soup.points.end(), finite))
        refuse(file,
               "The file cannot be read: check that it exists, that its name "
               "ends with .stl, .off, .ply or .obj, and what it holds.");
      Processing::repair_polygon_soup(soup.points, soup.polygons);
      if (soup.polygons.empty())
        refuse(file, "The file has no polygons: export the surface again.");
      return soup;
    }

    /** Refuses edges that do not have two polygons each. */
    void
    check_edges(const Soup &soup, const std::string &file)
    {
      std::map<std::pair<std::size_t, std::size_t>, unsigned int> edges;
      for (const std::vector<std::size_t> &polygon : soup.polygons)
        for (std::size_t i = 0; i < polygon.size(); ++i)
          ++edges[std::minmax(polygon[i], polygon[(i + 1) % polygon.size()])];

      const auto count = [&](const auto &predicate) {
        return std::count_if(edges.begin(), edges.end(), [&](const auto &edge) {
          return predicate(edge.second);
        });
      };
      const auto n_many =
        count([](const unsigned int n_polygons) { return n_polygons > 2; });
      const auto n_open =
        count([](const unsigned int n_polygons) { return n_polygons < 2; });
      if (n_many > 0)
        refuse(file,
               "The surface is non-manifold: " + std::to_string(n_many) +
                 " edges belong to more than two polygons. Remove inner walls "
                 "and fins, and separate bodies that touch.");
      if (n_open > 0)
        refuse(file,
               "The surface is open: " + std::to_string(n_open) +
                 " edges belong to one polygon only. Close the holes, or merge "
                 "the vertices that should coincide.");
    }

    Mesh
    read_mesh(const std::string &file)
    {
      Soup soup = read_soup(file);
      check_edges(soup, file);
      Processing::orient_polygon_soup(soup.points, soup.polygons);
      if (!Processing::is_polygon_soup_a_polygon_mesh(soup.polygons))
        refuse(file, "The surface is non-manifold: repair it.");

      Mesh mesh;
      Processing::polygon_soup_to_polygon_mesh(soup.points,
                                               soup.polygons,
                                               mesh);
      if (!CGAL::is_closed(mesh))
        refuse(file, "The surface has no inside: repair its orientation.");
      if (!Processing::triangulate_faces(mesh))
        refuse(file,
               "Some polygons cannot be cut into triangles: export the surface "
               "as triangles.");
      if (Processing::does_self_intersect(mesh))
        refuse(file,
               "The surface intersects or touches itself, or has triangles "
               "without area: repair it with a mesh editor.");
      Processing::orient_to_bound_a_volume(mesh);
      mesh.collect_garbage();
      return mesh;
    }

    Point<3>
    point(const Kernel::Point_3 &p)
    {
      return {p.x(), p.y(), p.z()};
    }
  } // namespace

  struct SurfaceMesh::Implementation
  {
    explicit Implementation(const std::string &file)
      : mesh(read_mesh(file))
      , tree(mesh.faces().begin(), mesh.faces().end(), mesh)
      , inside(tree)
    {}

    const Mesh   mesh;
    const Tree   tree;
    const Inside inside;
  };

  SurfaceMesh::SurfaceMesh(const std::string &file)
    : implementation(std::make_unique<Implementation>(file))
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

  const std::vector<SurfaceTriangle> &
  SurfaceMesh::triangles() const
  {
    return all_triangles;
  }

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
    return implementation->inside(p) == CGAL::ON_BOUNDED_SIDE &&
           !implementation->tree.do_intersect(
             Kernel::Sphere_3(p, clearance * clearance));
  }
} // namespace Morula
