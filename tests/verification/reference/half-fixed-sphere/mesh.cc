// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <half-fixed-sphere/mesh.h>

#include <array>
#include <cmath>
#include <vector>

namespace HalfFixedSphere
{
  namespace
  {
    using Corners = std::vector<Point<2>>;

    /**
     * The block with these corners (in deal.II's order: lower left, lower
     * right, upper left, upper right), n x n grid cells. If it is @p curved,
     * its right side is the arc about the origin between its right corners.
     */
    Triangulation<2>
    block(const Corners &corners, const bool curved, const unsigned int n)
    {
      const auto arc = [&](const double t) {
        const auto angle = [](const Point<2> &p) {
          return std::atan2(p[1], p[0]);
        };
        const double phi = (1. - t) * angle(corners[1]) + t * angle(corners[3]);
        return corners[1].norm() * Point<2>(std::cos(phi), std::sin(phi));
      };
      Triangulation<2> result;
      GridGenerator::subdivided_hyper_cube(result, n);
      GridTools::transform(
        [&](const Point<2> &s) {
          const Point<2> left = corners[0] + s[1] * (corners[2] - corners[0]);
          const Point<2> right =
            curved ? arc(s[1]) : corners[1] + s[1] * (corners[3] - corners[1]);
          return left + s[0] * (right - left);
        },
        result);
      return result;
    }

    Point<2>
    on_circle(const double radius, const double latitude)
    {
      return radius * Point<2>(std::cos(latitude), std::sin(latitude));
    }

    /** Boundary ids, and the sphere for all that is refined later. */
    void
    mark_boundary(const double      radius,
                  const double      edge,
                  Triangulation<2> &mesh)
    {
      const double slack = 1e-9 * radius;
      for (const auto &face : mesh.active_face_iterators())
        if (face->at_boundary())
          {
            if (face->vertex(0)[0] < slack && face->vertex(1)[0] < slack)
              face->set_boundary_id(axis);
            else
              {
                face->set_manifold_id(1);
                face->set_boundary_id(face->center()[1] < edge ? lower_surface :
                                                                 upper_surface);
              }
          }
      mesh.set_manifold(1, SphericalManifold<2>(Point<2>()));
    }

    /** Refines toward @p end and marks the grid cells within four of the
     * smallest sizes of it. */
    void
    refine(const double      radius,
           const Point<2>   &end,
           const MeshSize   &size,
           Triangulation<2> &mesh)
    {
      for (unsigned int level = 0; level < size.edge_levels; ++level)
        {
          for (const auto &cell : mesh.active_cell_iterators())
            for (const unsigned int v : cell->vertex_indices())
              if (cell->vertex(v).distance(end) < 1e-12 * radius)
                cell->set_refine_flag();
          mesh.execute_coarsening_and_refinement();
        }
      mesh.refine_global(size.uniform_levels);

      const double reach = 4.1 * innermost_size(radius, size);
      for (const auto &cell : mesh.active_cell_iterators())
        {
          cell->set_material_id(elsewhere);
          for (const unsigned int v : cell->vertex_indices())
            if (cell->vertex(v).distance(end) < reach)
              cell->set_material_id(near_edge);
        }
    }
  } // namespace


  double
  innermost_size(const double radius, const MeshSize &size)
  {
    return std::ldexp(0.25 * numbers::PI * radius / size.subdivisions,
                      -int(size.edge_levels + size.uniform_levels));
  }


  // Six blocks: below and above the edge one at the centre and two at the
  // surface. The latitudes of their corners on the surface follow the edge.
  void
  make_half_disc(const double      radius,
                 const double      edge,
                 const MeshSize   &size,
                 Triangulation<2> &mesh)
  {
    const double   inner = 0.5 * radius;
    const double   phi   = std::asin(edge / radius);
    const double   pole  = 0.5 * numbers::PI;
    const Point<2> centre(0., 0.), middle(inner, 0.);
    const Point<2> end = on_circle(radius, phi);

    std::array<Triangulation<2>, 6> blocks;
    for (const int side : {-1, +1})
      {
        const unsigned int first = side < 0 ? 0 : 3;
        const Point<2>     axis_point(0., side * inner);
        const Point<2>     corner(0.7 * inner, side * 0.7 * inner);
        const Point<2>     top  = on_circle(radius, side * pole);
        const Point<2>     half = on_circle(radius, 0.5 * (phi + side * pole));
        const auto         make =
          [&](const unsigned int i, const Corners &c, const bool curved) {
            blocks[first + i].copy_triangulation(
              block(c, curved, size.subdivisions));
          };
        // corners in an order that makes the grid cells positively oriented
        if (side > 0)
          {
            make(0, {centre, middle, axis_point, corner}, false);
            make(1, {middle, end, corner, half}, true);
            make(2, {corner, half, axis_point, top}, true);
          }
        else
          {
            make(0, {axis_point, corner, centre, middle}, false);
            make(1, {corner, half, middle, end}, true);
            make(2, {axis_point, top, corner, half}, true);
          }
      }
    GridGenerator::merge_triangulations(
      {&blocks[0], &blocks[1], &blocks[2], &blocks[3], &blocks[4], &blocks[5]},
      mesh,
      1e-9 * radius);
    mark_boundary(radius, edge, mesh);
    refine(radius, end, size, mesh);
  }
} // namespace HalfFixedSphere
