// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/voronoi/wall_distance.h>

#include <CGAL/Fuzzy_sphere.h>
#include <CGAL/Kd_tree.h>
#include <CGAL/Search_traits_2.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

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

    using Kernel = CGAL::Simple_cartesian<double>;

    template <int dim>
    struct SpatialTypes;

    template <>
    struct SpatialTypes<2>
    {
      using Point  = Kernel::Point_2;
      using Traits = CGAL::Search_traits_2<Kernel>;
    };

    template <>
    struct SpatialTypes<3>
    {
      using Point  = Kernel::Point_3;
      using Traits = CGAL::Search_traits_3<Kernel>;
    };


    /** Points in a leaf of a search tree. A tree of CGAL's usual 10 takes
     *  twice as long to make. */
    constexpr unsigned int bucket_size = 40;

    /** Points in a kd-tree, each with its index. */
    template <int dim>
    class PointTree
    {
    public:
      using Entry = std::pair<typename SpatialTypes<dim>::Point, std::size_t>;
      using Traits =
        CGAL::Search_traits_adapter<Entry,
                                    CGAL::First_of_pair_property_map<Entry>,
                                    typename SpatialTypes<dim>::Traits>;
      using Tree     = CGAL::Kd_tree<Traits>;
      using Splitter = typename Tree::Splitter;
      using Sphere   = CGAL::Fuzzy_sphere<Traits>;

      template <typename Position>
      PointTree(const std::size_t n_points, const Position &position)
        : tree(Splitter(bucket_size))
      {
        std::vector<Entry> entries;
        entries.reserve(n_points);
        for (std::size_t i = 0; i < n_points; ++i)
          entries.emplace_back(convert(position(i)), i);
        tree.insert(entries.begin(), entries.end());
        if (n_points > 0)
          tree.build();
      }

      /** Indices of the points within @p radius. */
      void
      find_within(const Point<dim>   &center,
                  const double        radius,
                  std::vector<Entry> &found) const
      {
        found.clear();
        tree.search(std::back_inserter(found), Sphere(convert(center), radius));
      }

    private:
      static typename SpatialTypes<dim>::Point
      convert(const Point<dim> &p)
      {
        if constexpr (dim == 2)
          return {p[0], p[1]};
        else
          return {p[0], p[1], p[2]};
      }

      Tree tree;
    };


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
     * Where the rays from a cell meet the half-spaces of the Dirichlet
     * boundary. A cell on or beyond a half-space counts as standing 1e-3
     * lengths inside: daughters neither leave nor coincide.
     */
    template <int dim>
    void
    meet_dirichlet_walls(
      const DividingCell<dim>                           &cell,
      const std::vector<WallPoint<dim>>                 &walls,
      const std::vector<typename PointTree<dim>::Entry> &near,
      WallDistances                                     &distances)
    {
      for (const auto &entry : near)
        {
          const WallPoint<dim> &wall = walls[entry.second];
          const double depth = (wall.position - cell.position) * wall.normal;
          if (depth < -deepest_overlap * cell.length)
            continue;

          const double slope = cell.axis * wall.normal;
          if (slope == 0.)
            continue;

          const double distance =
            std::max(depth, contact * cell.length) / std::abs(slope);
          const Point<dim> hit =
            cell.position + (slope > 0. ? distance : -distance) * cell.axis;
          if (hit.distance(wall.position) <= wall.spacing)
            take_nearer(distances[slope > 0.], distance, cell.length);
        }
    }


    /**
     * Where the rays from a cell leave its Voronoi region. The wall against a
     * neighbour at distance r is no nearer than r/2, so that neighbours within
     * twice the cell's length hold all walls that count. Being a minimum over
     * these, the result does not depend on the order of the points.
     *
     * Neighbours within 1e-3 lengths count as coinciding and bound nothing; a
     * wall is therefore at least 5e-4 lengths away.
     */
    template <int dim>
    void
    meet_voronoi_walls(const DividingCell<dim>                           &cell,
                       const std::vector<typename PointTree<dim>::Entry> &near,
                       const std::vector<types::particle_index>          &ids,
                       const std::vector<Point<dim>> &positions,
                       WallDistances                 &distances)
    {
      for (const auto &entry : near)
        {
          const std::size_t    q = entry.second;
          const Tensor<1, dim> r = positions[q] - cell.position;
          if (ids[q] == cell.id || r.norm() < contact * cell.length)
            continue;

          const double along = r * cell.axis;
          if (along != 0.)
            take_nearer(distances[along > 0.],
                        r.norm_square() / (2. * std::abs(along)),
                        cell.length);
        }
    }


    /** Equations (16), (19), (20): half way to the walls. */
    std::array<double, 2>
    place_daughters(const WallDistances &distances, const double length)
    {
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
                     const std::vector<WallPoint<dim>>        &walls)
  {
    AssertDimension(ids.size(), positions.size());

    std::vector<std::array<double, 2>> result;
    if (dividing.empty())
      return result;
    result.reserve(dividing.size());

    const PointTree<dim> cells(positions.size(), [&](const std::size_t i) {
      return positions[i];
    });
    const PointTree<dim> wall_tree(walls.size(), [&](const std::size_t i) {
      return walls[i].position;
    });

    double largest_spacing = 0.;
    for (const WallPoint<dim> &wall : walls)
      largest_spacing = std::max(largest_spacing, wall.spacing);

    std::vector<typename PointTree<dim>::Entry> near;
    for (const DividingCell<dim> &cell : dividing)
      {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        WallDistances    distances{{infinity, infinity}};
        if (!walls.empty())
          {
            wall_tree.find_within(cell.position,
                                  (1. + search_slack) *
                                    (cell.length + largest_spacing),
                                  near);
            meet_dirichlet_walls(cell, walls, near, distances);
          }
        cells.find_within(cell.position,
                          2. * (1. + search_slack) * cell.length,
                          near);
        meet_voronoi_walls(cell, near, ids, positions, distances);
        result.push_back(place_daughters(distances, cell.length));
      }
    return result;
  }


  template std::vector<std::array<double, 2>>
  daughter_distances<2>(const std::vector<DividingCell<2>> &,
                        const std::vector<types::particle_index> &,
                        const std::vector<Point<2>> &,
                        const std::vector<WallPoint<2>> &);
  template std::vector<std::array<double, 2>>
  daughter_distances<3>(const std::vector<DividingCell<3>> &,
                        const std::vector<types::particle_index> &,
                        const std::vector<Point<3>> &,
                        const std::vector<WallPoint<3>> &);
} // namespace Morula
