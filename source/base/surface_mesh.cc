// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/surface_mesh.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/boost_adaptors/bounding_box.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OBJ.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <locale>
#include <map>
#include <regex>
#include <sstream>

namespace Morula
{
  namespace
  {
    namespace Processing = CGAL::Polygon_mesh_processing;

    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Mesh   = CGAL::Surface_mesh<Kernel::Point_3>;
    using Inside = CGAL::Side_of_triangle_mesh<Mesh, Kernel>;
    using Tree   = Inside::AABB_tree;

    template <typename Position>
    std::string
    place(const Position &p)
    {
      std::ostringstream text;
      text << '(' << p.x() << ", " << p.y() << ", " << p.z() << ')';
      return text.str();
    }

    /** The polygons of a file, which does not say which ones are neighbours. */
    struct Soup
    {
      std::vector<Kernel::Point_3>          points;
      std::vector<std::vector<std::size_t>> polygons;
      std::size_t                           n_merged = 0;
    };

    /** A file and the path of the key that names it. */
    struct NamedFile
    {
      const std::string &key;
      const std::string &name;
    };

    [[noreturn]] void
    refuse(const NamedFile &file, const std::string &remedy)
    {
      throw InputError(file.key,
                       file.name,
                       "a closed surface that does not intersect itself, as an "
                       "STL, OFF, PLY or OBJ file",
                       remedy);
    }

    /** The file's ending in small letters, with its point. */
    std::string
    ending_of(const NamedFile &file)
    {
      return boost::algorithm::to_lower_copy(
        file.name.substr(std::min(file.name.rfind('.'), file.name.size())));
    }

    /** All bytes of a file; nothing of one that is not there. */
    std::string
    content_of(const NamedFile &file)
    {
      std::ifstream stream(file.name, std::ios::binary);
      return {std::istreambuf_iterator<char>(stream),
              std::istreambuf_iterator<char>()};
    }

    /** Whether @p word, a blank and something else stand in a line. */
    bool
    begins_with_word(const std::string &line, const std::string &word)
    {
      return line == word || boost::algorithm::starts_with(line, word + ' ');
    }

    /** Whether CGAL's reader of a format needs a line of a text. What is
     *  dropped are remarks, and what an OBJ file says besides the surface. */
    bool
    is_needed(const std::string &line, const std::string &ending)
    {
      if (line.empty() || line[0] == '#')
        return false;
      if (ending == ".obj")
        return begins_with_word(line, "v") || begins_with_word(line, "f");
      return ending != ".ply" || !(begins_with_word(line, "comment") ||
                                   begins_with_word(line, "obj_info"));
    }

    /**
     * A text without what CGAL's readers stumble over: byte order mark, line
     * ends with a carriage return, tabs, blanks around lines, blank lines,
     * remarks, and letters of the wrong case. Names of solids go, since they
     * may be words of the format.
     */
    std::string
    plain_text(std::string text, const std::string &ending)
    {
      if (boost::algorithm::starts_with(text, "\xEF\xBB\xBF"))
        text.erase(0, 3);
      std::replace(text.begin(), text.end(), '\t', ' ');
      boost::algorithm::replace_all(text, "\r\n", "\n");
      std::replace(text.begin(), text.end(), '\r', '\n');
      if (ending == ".obj")
        boost::algorithm::replace_all(text, "\\\n", " ");
      boost::algorithm::to_lower(text, std::locale::classic());

      std::istringstream stream(text);
      std::string        result;
      for (std::string line; std::getline(stream, line);)
        {
          boost::algorithm::trim(line);
          if (!is_needed(line, ending))
            continue;
          if (ending == ".off" && result.empty())
            boost::algorithm::to_upper(line);
          if (ending == ".stl" && line.find("outer loop") == std::string::npos)
            for (const std::string word : {"solid", "endsolid"})
              if (begins_with_word(line, word))
                line = word;
          result += line + '\n';
        }
      return result;
    }

    /** What a file holds, as CGAL's readers understand it. A binary file is
     * left as it is, but for the header of a PLY file, which is text. */
    std::string
    readable(const std::string &content, const std::string &ending)
    {
      const std::string last = "end_header";
      if (content.find('\0') == std::string::npos)
        return plain_text(content, ending);
      const auto begin = content.find(last);
      if (ending != ".ply" || begin == std::string::npos)
        return content;
      const std::string header = content.substr(0, begin);
      const std::size_t line_end =
        header.find("\r\n") == std::string::npos ? 1 : 2;
      return plain_text(header, ending) + last + '\n' +
             content.substr(
               std::min(begin + last.size() + line_end, content.size()));
    }

    /** Refuses what is no mesh at all, by what stands at its beginning. */
    void
    check_kind(const std::string &content, const NamedFile &file)
    {
      const auto begins = [&](const std::string &bytes) {
        return boost::algorithm::starts_with(content, bytes);
      };
      if (content.find_first_not_of(" \t\r\n") == std::string::npos)
        refuse(file, "The file is empty: copy or export it again.");
      if (begins("\xFF\xFE") || begins("\xFE\xFF"))
        refuse(file, "The file is written in UTF-16: save it in UTF-8.");
      if (begins("\x1F\x8B") || begins("PK\x03\x04"))
        refuse(file, "The file is compressed: unpack it first.");
      if (begins("version https://git-lfs"))
        refuse(file,
               "The file only says where Git LFS keeps the mesh: fetch it with "
               "'git lfs pull'.");
    }

    /** Refuses an STL file that ends before its last triangle. */
    void
    check_complete(const std::string &text, const NamedFile &file)
    {
      if (text.find('\0') == std::string::npos)
        {
          if (text.find("facet") == std::string::npos)
            refuse(file,
                   "The file is a text without the word 'facet', and begins "
                   "with '" +
                     text.substr(0,
                                 std::min<std::size_t>(text.find('\n'), 40)) +
                     "': it is no STL file.");
          if (text.find("endsolid") == std::string::npos)
            refuse(file,
                   "The file is cut off: it has no 'endsolid'. Copy or export "
                   "it again.");
          return;
        }
      // 80 bytes of header, the number of triangles, 50 bytes each
      std::uint32_t n = 0;
      if (text.size() >= 84)
        std::memcpy(&n, text.data() + 80, sizeof(n));
      const std::size_t there = text.size() < 84 ? 0 : (text.size() - 84) / 50;
      if (text.size() < 84 || there < n)
        refuse(file,
               "The file is cut off: it has " + std::to_string(there) +
                 " whole triangles" +
                 (text.size() < 84 ?
                    "" :
                    ", and says that it has " + std::to_string(n)) +
                 ". Copy or export it again.");
    }

    /** Lets CGAL's reader of the format @p ending append to @p soup.
     *  @returns whether it could */
    bool
    read_polygons(const std::string &text,
                  const std::string &ending,
                  Soup              &soup)
    {
      std::istringstream stream(text, std::ios::in | std::ios::binary);
      if (ending == ".stl" || ending == ".ply")
        CGAL::IO::set_mode(stream, CGAL::IO::BINARY);
      if (ending == ".stl")
        return CGAL::IO::read_STL(stream, soup.points, soup.polygons);
      if (ending == ".ply")
        return CGAL::IO::read_PLY(stream, soup.points, soup.polygons);
      if (ending == ".obj")
        return CGAL::IO::read_OBJ(stream, soup.points, soup.polygons);
      return ending == ".off" &&
             CGAL::IO::read_OFF(stream, soup.points, soup.polygons);
    }

    /** Refuses coordinates that are no numbers, or so large that areas and
     *  volumes would overflow. */
    void
    check_finite(const Soup &soup, const NamedFile &file)
    {
      for (std::size_t i = 0; i < soup.points.size(); ++i)
        {
          const Kernel::Point_3 &p = soup.points[i];
          const double           largest =
            std::max({std::abs(p.x()), std::abs(p.y()), std::abs(p.z())});
          if (std::isnan(p.x() + p.y() + p.z()) || !(largest < 1e100))
            refuse(file,
                   "Vertex " + std::to_string(i) + " (counted from 0) is at " +
                     place(p) + " um: export the surface again, in um.");
        }
    }

    /** How often each edge belongs to a polygon; 2 if the surface is closed. */
    using Edges = std::map<std::pair<std::size_t, std::size_t>, unsigned int>;

    Edges
    edges_of(const Soup &soup)
    {
      Edges edges;
      for (const std::vector<std::size_t> &polygon : soup.polygons)
        for (std::size_t i = 0; i < polygon.size(); ++i)
          ++edges[std::minmax(polygon[i], polygon[(i + 1) % polygon.size()])];
      return edges;
    }

    /**
     * Merges vertices that differ by rounding only. Most files have been
     * through single precision, in which a vertex that was computed in two ways
     * differs by some 1e-7 of its coordinates; the digits that others write are
     * as many or more. No cell is as small. A vertex goes to the first one in
     * the file that it is near to, so that the result does not depend on the
     * order of a search.
     * @returns how many vertices have gone
     */
    std::size_t
    merge_vertices(Soup &soup)
    {
      std::vector<Point<3>> points;
      double                largest = 0.;
      for (const Kernel::Point_3 &p : soup.points)
        {
          points.emplace_back(p.x(), p.y(), p.z());
          for (unsigned int d = 0; d < 3; ++d)
            largest = std::max(largest, std::abs(points.back()[d]));
        }
      const double near = 4. * std::numeric_limits<float>::epsilon() * largest;

      const auto               tree = pack_rtree_of_indices(points);
      std::vector<std::size_t> first(points.size());
      std::size_t              n_merged = 0;
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          BoundingBox<3> around({points[i], points[i]});
          around.extend(near);
          first[i] = i;
          for (const auto k :
               tree | boost::geometry::index::adaptors::queried(
                        boost::geometry::index::intersects(around)))
            if (k < first[i] && first[k] == k)
              first[i] = k;
          n_merged += first[i] != i;
        }
      for (std::vector<std::size_t> &polygon : soup.polygons)
        for (std::size_t &vertex : polygon)
          vertex = first[vertex];
      return n_merged;
    }

    Soup
    read_soup(const NamedFile &file)
    {
      const std::string ending = ending_of(file), content = content_of(file);
      if (std::ifstream(file.name))
        check_kind(content, file);
      Soup soup;
      bool good = false;
      if (!content.empty())
        {
          const std::string text = readable(content, ending);
          if (ending == ".stl")
            check_complete(text, file);
          try
            {
              good = read_polygons(text, ending, soup);
            }
          catch (const std::exception &)
            {
              // a file that it could not parse is reported below
            }
        }
      static const std::regex decimal_comma("[0-9],[0-9]");
      if (!good && content.find('\0') == std::string::npos &&
          std::regex_search(content, decimal_comma))
        refuse(
          file,
          "The file cannot be read: its numbers have commas. Write decimal "
          "points, and blanks between numbers.");
      if (!good)
        refuse(file,
               "The file cannot be read: check that it exists, that its name "
               "ends with .stl, .off, .ply or .obj, that it is whole, and that "
               "it holds numbers only.");
      for (const std::vector<std::size_t> &polygon : soup.polygons)
        for (const std::size_t vertex : polygon)
          if (vertex >= soup.points.size())
            refuse(file,
                   "The file cannot be read: a polygon names a vertex that is "
                   "none of the " +
                     std::to_string(soup.points.size()) + " there.");
      check_finite(soup, file);
      Processing::repair_polygon_soup(soup.points, soup.polygons);
      if (soup.polygons.empty())
        refuse(file, "The file has no polygons: export the surface again.");
      const Edges edges = edges_of(soup);
      // A closed surface stays as it is.
      if (std::any_of(edges.begin(), edges.end(), [](const auto &edge) {
            return edge.second < 2;
          }))
        {
          soup.n_merged = merge_vertices(soup);
          if (soup.n_merged > 0)
            Processing::repair_polygon_soup(soup.points, soup.polygons);
        }
      return soup;
    }

    /** Refuses a surface with an edge that does not have two polygons. */
    void
    check_edges(const Soup &soup, const NamedFile &file)
    {
      std::size_t n_many = 0, n_open = 0;
      std::string first_many, first_open;
      for (const auto &[edge, n_polygons] : edges_of(soup))
        if (n_polygons != 2)
          {
            ++(n_polygons > 2 ? n_many : n_open);
            std::string &first = n_polygons > 2 ? first_many : first_open;
            if (first.empty())
              first = place(soup.points[edge.first]) + " to " +
                      place(soup.points[edge.second]) + " um";
          }
      if (n_many > 0)
        refuse(file,
               "The surface is non-manifold: " + std::to_string(n_many) +
                 " edges belong to more than two polygons, such as that from " +
                 first_many +
                 ". Remove inner walls and fins, and separate bodies that "
                 "touch.");
      if (n_open > 0)
        refuse(file,
               "The surface is open: " + std::to_string(n_open) +
                 " edges belong to one polygon only, such as that from " +
                 first_open +
                 ". Close the holes, or merge the vertices that should "
                 "coincide.");
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
    check_areas(const Mesh &mesh, const NamedFile &file)
    {
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
            refuse(file,
                   "The triangle with the corners " + corners(mesh, face) +
                     " has no area: remove such triangles with a mesh editor, "
                     "or export the surface again.");
        }
    }

    /** Refuses triangles that cross or touch other ones than their neighbours.
     */
    void
    check_intersections(const Mesh &mesh, const NamedFile &file)
    {
      std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
      Processing::self_intersections(mesh, std::back_inserter(pairs));
      if (pairs.empty())
        return;
      const auto [one, other] = *std::min_element(pairs.begin(), pairs.end());
      refuse(file,
             "The surface intersects or touches itself: " +
               std::to_string(pairs.size()) +
               " pairs of triangles meet, such as those with the corners " +
               corners(mesh, one) + " and " + corners(mesh, other) +
               ". Repair it with a mesh editor.");
    }

    Mesh
    read_mesh(const NamedFile &file)
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
      check_areas(mesh, file);
      check_intersections(mesh, file);
      Processing::orient_to_bound_a_volume(mesh);
      mesh.collect_garbage();
      return mesh;
    }

    Point<3>
    point(const Kernel::Point_3 &p)
    {
      return {p.x(), p.y(), p.z()};
    }

    /** From vertex i to the next one. */
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

  struct SurfaceMesh::Implementation
  {
    explicit Implementation(const NamedFile &file)
      : mesh(read_mesh(file))
      , tree(mesh.faces().begin(), mesh.faces().end(), mesh)
      , inside(tree)
    {}

    const Mesh   mesh;
    const Tree   tree;
    const Inside inside;
  };

  SurfaceMesh::SurfaceMesh(const std::string &key, const std::string &file)
    : implementation(std::make_unique<Implementation>(NamedFile{key, file}))
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
    // Straight above or below a triangle, or so near to the surface that
    // rounding decides where.
    if (length < 1e-7 * edge(triangle, 0).norm() + 1e-9 * x.norm() ||
        cross_product_3d(way, n).norm() < 1e-6 * length)
      return {way * n, n, Tensor<2, 3>()};
    const bool   is_inside = implementation->inside(p) == CGAL::ON_BOUNDED_SIDE;
    const double distance  = is_inside ? -length : length;
    const Tensor<1, 3> direction = way / distance;
    const Tensor<2, 3> across    = directions_across(triangle, point(closest));
    return {distance,
            direction,
            (across - outer_product(direction, direction)) / distance};
  }

  void
  review_mesh(const std::string &key, const std::string &name, Review &review)
  {
    const std::size_t n_merged = read_soup({key, name}).n_merged;
    if (n_merged > 0)
      review.warn(key,
                  name,
                  std::to_string(n_merged) +
                    " of its vertices differ from others by rounding only, and "
                    "were merged with them: without that the surface is open.",
                  "Merge them in a mesh editor if they were meant to differ.");
  }
} // namespace Morula
