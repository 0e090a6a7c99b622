// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/particles/neighbours.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/tensor.h>

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

// A facet between two points is dual to their edge in Delaunay's triangulation.
// Its area is a sum over the simplices at the edge. CGAL's own dual() looks for
// its simplex among all where assertions are on, so circumcentres are computed
// here, from the vertices in the order of their ids.

namespace Morula
{
  namespace
  {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

    template <int dim>
    struct Simplices;

    template <>
    struct Simplices<2>
    {
      using Vertex =
        CGAL::Triangulation_vertex_base_with_info_2<unsigned int, Kernel>;
      using Structure     = CGAL::Triangulation_data_structure_2<Vertex>;
      using Triangulation = CGAL::Delaunay_triangulation_2<Kernel, Structure>;

      static auto
      all(const Triangulation &triangulation)
      {
        return triangulation.all_face_handles();
      }

      static Kernel::Point_2
      point(const Point<2> &x)
      {
        return {x[0], x[1]};
      }
    };

    template <>
    struct Simplices<3>
    {
      using Vertex =
        CGAL::Triangulation_vertex_base_with_info_3<unsigned int, Kernel>;
      using Structure = CGAL::Triangulation_data_structure_3<
        Vertex,
        CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
      using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Structure>;

      static auto
      all(const Triangulation &triangulation)
      {
        return triangulation.all_cell_handles();
      }

      static Kernel::Point_3
      point(const Point<3> &x)
      {
        return {x[0], x[1], x[2]};
      }
    };

    /**
     * The areas of the facets of each point a with points b > a. They are sums
     * of integers, so that the order in which CGAL visits its simplices, and
     * what else is in the list, leave no trace.
     */
    class Sums
    {
    public:
      struct Sum
      {
        unsigned int b;
        std::int64_t units;
      };

      /** @param largest about the largest area, µm^(dim-1) */
      Sums(const unsigned int n_points, const double largest)
        : of_points(n_points)
        , unit(std::ldexp(largest, -n_bits))
      {}

      void
      add(const unsigned int i, const unsigned int j, const double area)
      {
        // By rounding a simplex may have no volume, and no circumcentre.
        if (!std::isfinite(area))
          return;
        const unsigned int b     = std::max(i, j);
        const std::int64_t units = std::llround(area / unit);
        // A point has about eight of them.
        for (Sum &sum : of_points[std::min(i, j)])
          if (sum.b == b)
            {
              sum.units += units;
              return;
            }
        of_points[std::min(i, j)].push_back({b, units});
      }

      /** Sorts the facets of point @p a, and calls visit(b, area) for them. */
      template <typename Visit>
      void
      for_facets(const unsigned int a, const Visit &visit)
      {
        std::sort(of_points[a].begin(),
                  of_points[a].end(),
                  [](const Sum &one, const Sum &other) {
                    return one.b < other.b;
                  });
        for (const Sum &sum : of_points[a])
          visit(sum.b, unit * static_cast<double>(sum.units));
      }

    private:
      /** As fine as doubles, and room for a thousand of the largest. */
      static constexpr int          n_bits = 52;
      std::vector<std::vector<Sum>> of_points;
      double                        unit;
    };

    constexpr double infinite = std::numeric_limits<double>::infinity();

    /** Points, and what of their facets counts. */
    template <int dim>
    struct Diagram
    {
      const std::vector<Point<dim>> &points;
      const double                   reach, radius;
      Sums                          &sums;
      /** The outward normal of the first face that is seen at each edge of the
       *  hull, in 3-D. */
      std::map<std::pair<unsigned int, unsigned int>, Tensor<1, dim>> &outward;

      /** How far from its middle a facet counts, for this edge. */
      double
      rho(const double length) const
      {
        return std::sqrt(
          std::max(0., radius * radius - 0.25 * length * length));
      }
    };

    /** The area that a circle around its acute corner leaves of a triangle with
     *  a right angle: @p rho is the radius, @p near the side from the corner to
     *  the right angle, @p across the other one, which may have no end. */
    double
    cut_area(const double near, const double across, const double rho)
    {
      if (near >= rho)
        return 0.5 * rho * rho * std::atan2(across, near);
      const double inside = std::sqrt(rho * rho - near * near);
      if (across <= inside)
        return 0.5 * near * across;
      return 0.5 * near * inside +
             0.5 * rho * rho *
               ((across == infinite ? 0.5 * numbers::PI :
                                      std::atan2(across, near)) -
                std::atan2(inside, near));
    }

    /** Circumcentre of a triangle minus its first corner, from its edges @p u
     *  and @p v there. */
    Tensor<1, 3>
    circumcenter(const Tensor<1, 3> &u, const Tensor<1, 3> &v)
    {
      const Tensor<1, 3> n = cross_product_3d(u, v);
      return (u.norm_square() * cross_product_3d(v, n) +
              v.norm_square() * cross_product_3d(n, u)) /
             (2. * n.norm_square());
    }

    /** The parts of a triangle: of each edge the signed distance from its
     *  middle to the circumcentre. */
    void
    add_parts(const Diagram<2>                  &diagram,
              const std::array<unsigned int, 3> &corners)
    {
      const auto        &x     = diagram.points;
      const Tensor<1, 2> u     = x[corners[1]] - x[corners[0]];
      const Tensor<1, 2> v     = x[corners[2]] - x[corners[0]];
      const double       twice = 2. * (u[0] * v[1] - u[1] * v[0]);
      Tensor<1, 2>       c;
      c[0] = (v[1] * u.norm_square() - u[1] * v.norm_square()) / twice;
      c[1] = (u[0] * v.norm_square() - v[0] * u.norm_square()) / twice;
      const std::array<Tensor<1, 2>, 3> y = {{Tensor<1, 2>(), u, v}};
      for (unsigned int k = 0; k < 3; ++k)
        {
          const unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
          const Tensor<1, 2> edge   = y[j] - y[i];
          const double       length = edge.norm();
          if (length > diagram.reach)
            continue;
          const Tensor<1, 2> middle = 0.5 * (y[i] + y[j]);
          const Tensor<1, 2> inward = cross_product_2d(edge) / length;
          const double       sign   = inward * (y[k] - middle) > 0. ? 1. : -1.;
          const double       rho    = diagram.rho(length);
          diagram.sums.add(corners[i],
                           corners[j],
                           std::clamp(sign * (inward * (c - middle)),
                                      -rho,
                                      rho));
        }
    }

    /** The part of an edge of the hull, outward from its middle. */
    void
    add_outer_parts(const Diagram<2>                  &diagram,
                    const std::array<unsigned int, 2> &edge,
                    const unsigned int)
    {
      const double length =
        diagram.points[edge[0]].distance(diagram.points[edge[1]]);
      if (length <= diagram.reach)
        diagram.sums.add(edge[0], edge[1], diagram.rho(length));
    }

    /**
     * The part of a face at its edge (i, j) with the third corner k: a signed
     * triangle of the edge's middle, the face's circumcentre, and a point on
     * the face's axis, which is the circumcentre of the tetrahedron.
     * @param f    circumcentre of the face minus the edge's middle
     * @param turn orientation of the tetrahedron about the edge
     * @param way  from the face's circumcentre along its axis
     * @param far  how far along
     */
    double
    part_of_face(const Tensor<1, 3> &f,
                 const Tensor<1, 3> &axis,
                 const double        turn,
                 const Tensor<1, 3> &way,
                 const double        far,
                 const double        rho)
    {
      const double sign = turn * (axis * cross_product_3d(f, way));
      return std::copysign(cut_area(f.norm(), far, rho), sign);
    }

    /** The parts of a tetrahedron, two for each edge: one for each face there.
     *  If nothing of them is cut off, as nearly always, their sum has a simple
     *  form without roots and angles. */
    void
    add_parts(const Diagram<3>                  &diagram,
              const std::array<unsigned int, 4> &corners)
    {
      std::array<Tensor<1, 3>, 4> y;
      for (unsigned int i = 1; i < 4; ++i)
        y[i] = diagram.points[corners[i]] - diagram.points[corners[0]];
      const Tensor<1, 3> c =
        (y[1].norm_square() * cross_product_3d(y[2], y[3]) +
         y[2].norm_square() * cross_product_3d(y[3], y[1]) +
         y[3].norm_square() * cross_product_3d(y[1], y[2])) /
        (2. * (y[1] * cross_product_3d(y[2], y[3])));
      const bool is_whole = c.norm_square() <= diagram.radius * diagram.radius;
      // The circumcentre of the face opposite of each corner.
      std::array<Tensor<1, 3>, 4> of_face;
      for (unsigned int k = 0; k < 4; ++k)
        {
          const unsigned int i = k == 0 ? 1 : 0, j = k <= 1 ? 2 : 1,
                             l = k == 3 ? 2 : 3;
          of_face[k]           = y[i] + circumcenter(y[j] - y[i], y[l] - y[i]);
        }
      for (unsigned int i = 0; i < 4; ++i)
        for (unsigned int j = i + 1; j < 4; ++j)
          {
            const Tensor<1, 3> edge   = y[j] - y[i];
            const double       length = edge.norm();
            if (length > diagram.reach)
              continue;
            const unsigned int k    = i == 0 ? (j == 1 ? 2 : 1) : 0;
            const unsigned int l    = 6 - i - j - k;
            const Tensor<1, 3> axis = edge / length;
            const Tensor<1, 3> m    = 0.5 * (y[i] + y[j]);
            // The face without l holds k; about the edge it lies on the other
            // side than the face without k.
            const double turns =
              axis * cross_product_3d(y[k] - m, y[l] - m) > 0. ? 1. : -1.;
            double area = 0.;
            if (is_whole)
              area = 0.5 * turns *
                     (axis * cross_product_3d(of_face[l] - of_face[k], c - m));
            else
              for (const unsigned int without : {l, k})
                {
                  const Tensor<1, 3> way = c - of_face[without];
                  area += part_of_face(of_face[without] - m,
                                       axis,
                                       without == l ? turns : -turns,
                                       way,
                                       way.norm(),
                                       diagram.rho(length));
                }
            diagram.sums.add(corners[i], corners[j], area);
          }
    }

    /** The parts of a face of the hull at its edges, outward to where nothing
     *  counts any more, and between the ways outward of the two faces at an
     *  edge. @param inner a point on the other side of it */
    void
    add_outer_parts(const Diagram<3>                  &diagram,
                    const std::array<unsigned int, 3> &face,
                    const unsigned int                 inner)
    {
      // The outward normal of the face comes first. Then each edge gets a part
      // as in a tetrahedron whose circumcentre is infinitely far outward. An
      // edge belongs to two faces of the hull, whose ways outward differ: the
      // first one leaves its normal, and the second adds the sector of the disc
      // of radius rho between the two.
      const auto        &x                = diagram.points;
      const Tensor<1, 3> u                = x[face[1]] - x[face[0]],
                         v                = x[face[2]] - x[face[0]];
      const std::array<Tensor<1, 3>, 3> y = {{Tensor<1, 3>(), u, v}};
      Tensor<1, 3>                      n = cross_product_3d(u, v);
      if (n * (x[inner] - x[face[0]]) > 0.)
        n = -n;
      n /= n.norm();
      const Tensor<1, 3> center = circumcenter(u, v);
      for (unsigned int k = 0; k < 3; ++k)
        {
          const unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
          const Tensor<1, 3> edge   = y[j] - y[i];
          const double       length = edge.norm();
          if (length > diagram.reach)
            continue;
          const Tensor<1, 3> axis = edge / length, m = 0.5 * (y[i] + y[j]);
          const double       turn =
            axis * cross_product_3d(y[k] - m, n) > 0. ? 1. : -1.;
          diagram.sums.add(
            face[i],
            face[j],
            part_of_face(
              center - m, axis, turn, n, infinite, diagram.rho(length)));
          const auto [first, is_first] =
            diagram.outward.try_emplace(std::minmax(face[i], face[j]), n);
          if (!is_first)
            diagram.sums.add(
              face[i],
              face[j],
              0.5 * std::pow(diagram.rho(length), 2) *
                std::atan2(cross_product_3d(first->second, n).norm(),
                           first->second * n));
        }
    }

    /** Calls @p visit(corners) for all simplices, and @p open(side, inner) for
     *  the sides of the hull, with the corner that faces each from inside. */
    template <int dim, typename Visit, typename Open>
    void
    for_simplices(const typename Simplices<dim>::Triangulation &triangulation,
                  const Visit                                  &visit,
                  const Open                                   &open)
    {
      for (const auto simplex : Simplices<dim>::all(triangulation))
        {
          std::array<unsigned int, dim + 1> corners = {};
          unsigned int                      n       = 0;
          for (int k = 0; k <= dim; ++k)
            if (!triangulation.is_infinite(simplex->vertex(k)))
              corners[n++] = simplex->vertex(k)->info();
          if (n == corners.size())
            {
              visit(corners);
              continue;
            }
          std::array<unsigned int, dim> side;
          std::copy_n(corners.begin(), dim, side.begin());
          const auto inside =
            simplex->neighbor(simplex->index(triangulation.infinite_vertex()));
          open(side, inside->vertex(inside->index(simplex))->info());
        }
    }
  } // namespace


  template <int dim>
  std::vector<VoronoiFacet>
  voronoi_facets(const std::vector<Point<dim>>            &points,
                 const std::vector<types::particle_index> &ids,
                 const double                              reach,
                 const double                              radius)
  {
    // Fewer than dim + 1 points, or points in one plane, have no simplex and no
    // facet.
    std::vector<
      std::pair<decltype(Simplices<dim>::point(points[0])), unsigned int>>
      list;
    for (unsigned int i = 0; i < points.size(); ++i)
      list.emplace_back(Simplices<dim>::point(points[i]), i);
    const typename Simplices<dim>::Triangulation triangulation(list.begin(),
                                                               list.end());
    std::vector<VoronoiFacet>                    facets;
    if (triangulation.dimension() < dim)
      return facets;
    Sums sums(points.size(), std::pow(radius, dim - 1));
    std::map<std::pair<unsigned int, unsigned int>, Tensor<1, dim>> outward;
    const Diagram<dim> diagram{points, reach, radius, sums, outward};
    const auto         by_ids = [&](auto corners) {
      std::sort(corners.begin(),
                corners.end(),
                [&](const unsigned int i, const unsigned int j) {
                  return ids[i] < ids[j];
                });
      return corners;
    };
    for_simplices<dim>(
      triangulation,
      [&](const auto &corners) { add_parts(diagram, by_ids(corners)); },
      [&](const auto &side, const unsigned int inner) {
        add_outer_parts(diagram, by_ids(side), inner);
      });
    for (unsigned int a = 0; a < points.size(); ++a)
      sums.for_facets(a, [&](const unsigned int b, const double area) {
        facets.push_back({a, b, area, points[a].distance(points[b])});
      });
    return facets;
  }


  MORULA_INSTANTIATE(voronoi_facets);
} // namespace Morula
