// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/closed_surface.h>

#include <deal.II/base/numbers.h>

#include <CGAL/Alpha_shape_2.h>
#include <CGAL/Alpha_shape_face_base_2.h>
#include <CGAL/Alpha_shape_vertex_base_2.h>
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Random.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>
#include <CGAL/subdivision_method_3.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <utility>

namespace Morula
{
  namespace
  {
    namespace Processing = CGAL::Polygon_mesh_processing;

    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Mesh   = CGAL::Surface_mesh<Kernel::Point_3>;
    using Inside = CGAL::Side_of_triangle_mesh<Mesh, Kernel>;

    /** Distance of the first surface from the points, in lengths of a cell. */
    constexpr double offset = 0.5;

    /** Fewer cells are surrounded by points first. */
    constexpr std::size_t few = 9;

    /** CGAL shuffles points before it inserts them. With the same numbers each
     *  time, the same cells have the same surface. */
    void
    restart_shuffling()
    {
      // CGAL's generator is global, so the state before does not matter any
      // more.
      CGAL::get_default_random() = CGAL::Random(0);
    }

    /** The centres of the balls beyond @p radius that touch four points and
     *  have none inside, the largest first. */
    std::vector<Kernel::Point_3>
    empty_balls(const std::vector<Kernel::Point_3> &points, const double radius)
    {
      // The cells of the Delaunay triangulation are those whose circumscribed
      // balls hold no point, so their centres are the places with the most
      // room.
      const CGAL::Delaunay_triangulation_3<Kernel>    delaunay(points.begin(),
                                                            points.end());
      std::vector<std::pair<double, Kernel::Point_3>> balls;
      for (const auto cell : delaunay.finite_cell_handles())
        {
          const Kernel::Point_3 center = delaunay.dual(cell);
          const double          square =
            CGAL::squared_distance(center, cell->vertex(0)->point());
          if (square > radius * radius)
            balls.emplace_back(square, center);
        }
      std::sort(balls.begin(), balls.end(), std::greater<>());
      std::vector<Kernel::Point_3> centers;
      for (const auto &ball : balls)
        centers.push_back(ball.second);
      return centers;
    }

    /** Appends a mesh to the surface, in smaller triangles: a wrap's are as
     *  large as its balls. */
    void
    append(Mesh &mesh, ClosedSurface<3> &surface)
    {
      // Loop's subdivision makes four triangles of each and smooths the
      // surface.
      CGAL::Subdivision_method_3::Loop_subdivision(mesh);
      const auto first = static_cast<unsigned int>(surface.vertices.size());
      for (const Mesh::Vertex_index v : mesh.vertices())
        {
          const Kernel::Point_3 &p = mesh.point(v);
          surface.vertices.emplace_back(p.x(), p.y(), p.z());
        }
      for (const Mesh::Face_index face : mesh.faces())
        {
          std::array<unsigned int, 3> facet;
          Mesh::Halfedge_index        edge = mesh.halfedge(face);
          for (unsigned int i = 0; i < 3; ++i, edge = mesh.next(edge))
            facet[i] =
              first + static_cast<unsigned int>(mesh.source(edge).idx());
          surface.facets.push_back(facet);
        }
    }

    /** Points round each, halfway to the first surface. Few points have a wrap
     * of few triangles, which need not have them inside. */
    std::vector<Kernel::Point_3>
    surrounded(const std::vector<Kernel::Point_3> &points, const double length)
    {
      std::vector<Kernel::Point_3> around;
      for (const Kernel::Point_3 &x : points)
        for (const double way : {-0.5 * offset * length, 0.5 * offset * length})
          {
            around.push_back(x + Kernel::Vector_3(way, 0., 0.));
            around.push_back(x + Kernel::Vector_3(0., way, 0.));
            around.push_back(x + Kernel::Vector_3(0., 0., way));
          }
      return around;
    }

    /** A closed mesh. */
    struct Wrap
    {
      Mesh                    mesh;
      bool                    is_cavity = false;
      std::unique_ptr<Inside> inside; // refers to mesh

      bool
      contains(const Kernel::Point_3 &x)
      {
        if (!inside)
          inside = std::make_unique<Inside>(mesh);
        return (*inside)(x) == CGAL::ON_BOUNDED_SIDE;
      }
    };

    /** The walls of the cavities in @p outer. @param alpha radius of the ball
     *  that must have room, in lengths of a cell */
    std::list<Wrap>
    cavities(const std::vector<Kernel::Point_3> &points,
             const double                        length,
             const double                        alpha,
             Wrap                               &outer)
    {
      std::list<Wrap> found;
      // A cavity has room for the wrap's ball. Each empty ball inside of the
      // outer wrap that no cavity found so far contains is the seed of a wrap
      // from within. The largest come first, so that one seed finds one cavity.
      for (const Kernel::Point_3 &center :
           empty_balls(points, (alpha + offset) * length))
        {
          if (!outer.contains(center) ||
              std::any_of(found.begin(), found.end(), [&](Wrap &other) {
                return other.contains(center) == other.is_cavity;
              }))
            continue;
          // CGAL 5.5 reads the last parameters, CGAL 6 those before.
          std::vector<Kernel::Point_3> seeds = {center};
          const auto                   from_seeds =
            CGAL::parameters::seed_points(std::ref(seeds));
          found.emplace_back();
          CGAL::alpha_wrap_3(points,
                             alpha * length,
                             offset * length,
                             found.back().mesh,
                             from_seeds,
                             from_seeds);
          // A wrap that does not contain its seed has leaked out and is the
          // outer surface again.
          found.back().is_cavity = found.back().contains(center);
        }
      found.remove_if([](const Wrap &wrap) { return !wrap.is_cavity; });
      return found;
    }
  } // namespace

  ClosedSurface<3>
  wrap_points(const std::vector<Point<3>> &points,
              const double                 length,
              const double                 gap)
  {
    // The outer wrap goes around all centres. With few cells the wrap is made
    // around points around them. Cavities are wrapped from within, and turned
    // so that their normals point out of the tissue.
    restart_shuffling();
    const double                 alpha = 0.5 * gap;
    std::vector<Kernel::Point_3> centers;
    for (const Point<3> &x : points)
      centers.emplace_back(x[0], x[1], x[2]);
    if (points.size() < few)
      centers = surrounded(centers, length);
    Wrap outer;
    CGAL::alpha_wrap_3(centers, alpha * length, offset * length, outer.mesh);
    ClosedSurface<3> surface;
    for (Wrap &cavity : cavities(centers, length, alpha, outer))
      {
        Processing::reverse_face_orientations(cavity.mesh);
        append(cavity.mesh, surface);
      }
    append(outer.mesh, surface);
    return surface;
  }

  ClosedSurface<2>
  wrap_points(const std::vector<Point<2>> &points,
              const double                 length,
              const double                 gap)
  {
    using Vertex   = CGAL::Alpha_shape_vertex_base_2<Kernel>;
    using Face     = CGAL::Alpha_shape_face_base_2<Kernel>;
    using Delaunay = CGAL::Delaunay_triangulation_2<
      Kernel,
      CGAL::Triangulation_data_structure_2<Vertex, Face>>;
    using Shape = CGAL::Alpha_shape_2<Delaunay>;

    // In 2-D the alpha shape of points on circles around the cells takes the
    // place of the wrap: its edges that bound the inside are the line. They are
    // collected with the inside on their left, put into an order that is always
    // the same, and numbered.
    restart_shuffling();
    // A polygon of eight points is at most 8 % of the radius inside of its
    // circle.
    constexpr unsigned int       n_around = 8;
    const double                 alpha    = 0.5 * gap;
    std::vector<Kernel::Point_2> around;
    for (const Point<2> &x : points)
      for (unsigned int i = 0; i < n_around; ++i)
        {
          const double angle = 2. * numbers::PI * i / n_around;
          around.emplace_back(x[0] + offset * length * std::cos(angle),
                              x[1] + offset * length * std::sin(angle));
        }
    Shape shape(around.begin(),
                // The regularised shape has no loose edges and points.
                around.end(),
                alpha * alpha * length * length,
                Shape::REGULARIZED);

    // CGAL's order of the edges depends on where they stand in memory; sorted,
    // the same cells have the same line.
    std::vector<std::pair<Kernel::Point_2, Kernel::Point_2>> segments;
    for (auto edge = shape.alpha_shape_edges_begin();
         edge != shape.alpha_shape_edges_end();
         ++edge)
      {
        const auto &[face, i] = *edge;
        segments.emplace_back(face->vertex(Shape::ccw(i))->point(),
                              face->vertex(Shape::cw(i))->point());
        // The face of the edge lies outside, so the edge is turned round.
        if (shape.classify(face) != Shape::INTERIOR)
          std::swap(segments.back().first, segments.back().second);
      }
    std::sort(segments.begin(), segments.end());

    ClosedSurface<2>                        surface;
    std::map<Kernel::Point_2, unsigned int> numbers;
    const auto number = [&](const Kernel::Point_2 &x) {
      const auto [place, is_new] =
        numbers.emplace(x, static_cast<unsigned int>(surface.vertices.size()));
      if (is_new)
        surface.vertices.emplace_back(x.x(), x.y());
      return place->second;
    };
    for (const auto &[from, to] : segments)
      {
        const unsigned int first = number(from);
        surface.facets.push_back({{first, number(to)}});
      }
    return surface;
  }
} // namespace Morula
