// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/division/divide.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Morula
{
  namespace
  {
    /** What counts as touching, as a fraction of the cell's length. */
    constexpr double contact = 1e-3;

    /** How far a cell may stand outside a half-space and still be bounded by
     *  it, as a fraction of its length. */
    constexpr double deepest_overlap = 0.1;

    /** Relative slack of searches, so that rounding cannot hide a candidate. */
    constexpr double search_slack = 1e-9;

    /** Distances of the nearest walls along -axis and +axis, none farther than
     *  the cell's length; infinite where there is none. */
    using WallDistances = std::array<double, 2>;

    void
    take_nearer(double &nearest, const double distance, const double cap)
    {
      if (distance <= cap)
        nearest = std::min(nearest, distance);
    }


    /**
     * Where the rays from a cell meet a half-space of the Dirichlet boundary. A
     * cell on or beyond it counts as standing 1e-3 lengths inside: daughters
     * neither leave nor coincide.
     */
    template <int dim>
    void
    meet_dirichlet_wall(const DividingCell<dim> &cell,
                        const WallPoint<dim>    &wall,
                        WallDistances           &distances)
    {
      // The half-space is behind the plane through the point with the outward
      // normal. The ray that goes outward meets it at depth/|axis·normal|, and
      // only that one of the two. The hit counts near the point alone, since
      // the plane stands for the surface only there.
      const double depth = (wall.position - cell.position) * wall.normal;
      // A cell far behind the plane belongs to another part of the body, which
      // this plane does not bound.
      if (depth < -deepest_overlap * cell.length)
        return;

      const double slope = cell.axis * wall.normal;
      if (slope == 0.)
        return;

      const double distance =
        std::max(depth, contact * cell.length) / std::abs(slope);
      const Point<dim> hit =
        cell.position + (slope > 0. ? distance : -distance) * cell.axis;
      if (hit.distance(wall.position) <= wall.spacing)
        take_nearer(distances[slope > 0.], distance, cell.length);
    }


    /**
     * Where the rays from a cell meet the wall against a neighbour. It is no
     * nearer than half the neighbour's distance, so that neighbours within
     * twice the cell's length hold all walls that count. Being a minimum over
     * these, the result does not depend on the order of the points.
     *
     * Neighbours within 1e-3 lengths count as coinciding and bound nothing; a
     * wall is therefore at least 5e-4 lengths away.
     */
    template <int dim>
    void
    meet_voronoi_wall(const DividingCell<dim> &cell,
                      const Point<dim>        &neighbor,
                      WallDistances           &distances)
    {
      // The wall is the plane half way to the neighbour, and a ray meets it at
      // |r|²/(2 |r·n|): doc/theory.md (6.5). The sign of r·n says which ray
      // does.
      const Tensor<1, dim> r     = neighbor - cell.position;
      const double         along = r * cell.axis;
      if (r.norm() >= contact * cell.length && along != 0.)
        take_nearer(distances[along > 0.],
                    r.norm_square() / (2. * std::abs(along)),
                    cell.length);
    }


    /** Equations (16), (19), (20): half way to the walls. */
    std::array<double, 2>
    place_daughters(const WallDistances &distances, const double length)
    {
      // A side without a wall takes the distance of the other one, equation
      // (19) of the paper. A cell without walls has its daughters a quarter of
      // its length away, (20), which is what walls at half a length on both
      // sides would give.
      const double nearer = std::min(distances[0], distances[1]);
      const double instead =
        std::isfinite(nearer) ? 0.5 * nearer : 0.25 * length;
      const auto place = [&](const double distance) {
        return std::isfinite(distance) ? 0.5 * distance : instead;
      };
      return {{place(distances[0]), place(distances[1])}};
    }
  } // namespace


  template <int dim>
  std::vector<std::array<double, 2>>
  daughter_distances(const std::vector<DividingCell<dim>>     &dividing,
                     const std::vector<types::particle_index> &ids,
                     const std::vector<Point<dim>>            &positions,
                     const std::vector<WallPoint<dim>>        &walls,
                     const GridBox<dim>                       &box)
  {
    AssertDimension(ids.size(), positions.size());

    std::vector<std::array<double, 2>> result;
    if (dividing.empty())
      return result;
    result.reserve(dividing.size());

    // Cells and walls are sorted into bins first, so that each dividing cell
    // looks only at those near it. The search for walls must reach as far as
    // the largest spacing beyond the cell's length, because a hit may be that
    // far from its point. Each visit takes the minimum over what it finds, so
    // the order of points and the copies from other ranks do not matter.
    double                  largest_spacing = 0.;
    std::vector<Point<dim>> wall_positions;
    for (const WallPoint<dim> &wall : walls)
      {
        largest_spacing = std::max(largest_spacing, wall.spacing);
        wall_positions.push_back(wall.position);
      }
    const PointBins<dim> cell_bins(box, positions);
    const PointBins<dim> wall_bins(box, wall_positions);

    for (const DividingCell<dim> &cell : dividing)
      {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        WallDistances    distances{{infinity, infinity}};
        if (!walls.empty())
          wall_bins.visit_within(
            cell.position,
            (1. + search_slack) * (cell.length + largest_spacing),
            [&](const unsigned int w) {
              meet_dirichlet_wall(cell, walls[w], distances);
            });
        cell_bins.visit_within(cell.position,
                               2. * (1. + search_slack) * cell.length,
                               [&](const unsigned int q) {
                                 if (ids[q] != cell.id)
                                   meet_voronoi_wall(cell,
                                                     positions[q],
                                                     distances);
                               });
        result.push_back(place_daughters(distances, cell.length));
      }
    return result;
  }


  MORULA_INSTANTIATE(daughter_distances);
} // namespace Morula
