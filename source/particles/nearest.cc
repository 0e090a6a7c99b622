// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/particles/nearest.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>

namespace Morula
{
  namespace
  {
    /** Grid cells by the rank that owns them, by number in order. */
    using GridCellsOfRanks = std::map<unsigned int, std::vector<unsigned int>>;

    /** The grid cells within a radius of a query. */
    template <int dim>
    GridCellsOfRanks
    near_queries(const std::vector<Point<dim>> &queries,
                 const BackgroundGrid<dim>     &grid,
                 const int                      radius)
    {
      const GridBox<dim> &box = grid.box();
      // Many queries share a grid cell, which is looked at once.
      std::set<GridIndex<dim>> with_query; // many queries share a grid cell
      for (const Point<dim> &query : queries)
        with_query.insert(box.locate(query));
      std::set<unsigned int> near;
      for (const GridIndex<dim> &index : with_query)
        box.for_neighbors(index,
                          radius,
                          [&](const unsigned int number, const auto &) {
                            near.insert(number);
                          });
      GridCellsOfRanks grid_cells;
      for (const unsigned int number : near)
        grid_cells[grid.owner(number)].push_back(number);
      return grid_cells;
    }

    /** This rank's points in some of its grid cells. */
    template <int dim>
    PointList<dim>
    points_in(const std::vector<unsigned int> &grid_cells,
              const PointStore<dim>           &points,
              const NearestQuery              &wanted)
    {
      std::vector<unsigned int> found;
      // Both lists are in the order of the numbers, so one pass through both is
      // enough.
      auto cell = points.grid_cells().begin();
      for (const unsigned int number : grid_cells)
        {
          while (cell != points.grid_cells().end() && cell->number < number)
            ++cell;
          for (; cell != points.grid_cells().end() && cell->number == number;
               ++cell)
            for (unsigned int p = cell->begin; p < cell->end; ++p)
              found.push_back(p);
        }
      PointList<dim>      list(wanted.n);
      std::vector<double> numbers;
      list.reserve(found.size());
      for (const unsigned int p : found)
        {
          numbers.clear();
          wanted.append(p, numbers);
          list.add(points.id(p), points.position(p), make_array_view(numbers));
        }
      return list;
    }

    /** Positions of the nearest points in the list, by id, and their distance.
     *  Distances that differ by rounding only count as equal. */
    template <int dim, typename Tree>
    std::pair<std::vector<unsigned int>, double>
    nearest(const Point<dim>     &query,
            const PointList<dim> &list,
            const Tree           &tree,
            const Side<dim>      &side = {})
    {
      // A lattice can have 2^dim points at the same distance. Twice as many are
      // looked at, so that all of them are found also beside a few nearer ones.
      constexpr unsigned int n_ties   = 2 << dim;
      double                 shortest = std::numeric_limits<double>::infinity();
      std::vector<unsigned int> found;
      namespace bgi = boost::geometry::index;
      if (side.n.norm_square() == 0.)
        tree.query(bgi::nearest(query, n_ties), std::back_inserter(found));
      else
        tree.query(bgi::nearest(query, n_ties) &&
                     bgi::satisfies([&](const unsigned int i) {
                       return side.has(query, list.positions[i]);
                     }),
                   std::back_inserter(found));
      for (const unsigned int i : found)
        shortest = std::min(shortest, query.distance(list.positions[i]));
      found.erase(std::remove_if(found.begin(),
                                 found.end(),
                                 [&](const unsigned int i) {
                                   return query.distance(list.positions[i]) >
                                          // Distances that differ by rounding
                                          // only count as equal; else the
                                          // choice would depend on the frame.
                                          // The order by id makes the sum of a
                                          // mean independent of ranks.
                                          shortest * (1. + 1e-9);
                                 }),
                  found.end());
      std::sort(found.begin(),
                found.end(),
                [&](const unsigned int i, const unsigned int j) {
                  return list.ids[i] < list.ids[j];
                });
      return {found, shortest};
    }

    /** Appends what is wanted of the points at @p found, of which there is one
     *  at least. */
    template <int dim>
    void
    append_wanted(const std::vector<unsigned int> &found,
                  const PointList<dim>            &list,
                  const Ties                       ties,
                  std::vector<double>             &numbers)
    {
      const std::size_t n = ties == Ties::mean ? found.size() : 1;
      for (unsigned int i = 0; i < list.n_numbers; ++i)
        {
          double sum = 0.;
          for (std::size_t k = 0; k < n; ++k)
            sum += list.row(found[k])[i];
          numbers.push_back(sum / n);
        }
    }
  } // namespace

  template <int dim>
  PointList<dim>
  near_points(const std::vector<Point<dim>> &queries,
              const PointStore<dim>         &points,
              const NearestQuery            &wanted,
              const BackgroundGrid<dim>     &grid,
              const int                      radius)
  {
    const MPI_Comm     comm = grid.communicator();
    const unsigned int rank = Utilities::MPI::this_mpi_process(comm);
    // Grid cells around the queries, by owner. This rank's own points in them
    // need no message.
    GridCellsOfRanks near = near_queries(queries, grid, radius);
    PointList<dim>   list = points_in(near[rank], points, wanted);
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return list;
    // Each rank asks the owners of these grid cells for their points, and
    // answers what others ask of it.
    near.erase(rank);
    std::map<unsigned int, PointList<dim>> points_to;
    for (const auto &[asking, grid_cells] :
         Utilities::MPI::some_to_some(comm, near))
      points_to.emplace(asking, points_in(grid_cells, points, wanted));
    list.append(exchange(points_to, wanted.n, comm));
    return list;
  }

  namespace
  {
    /** nearest_numbers() among points of the same side. */
    template <int dim>
    std::vector<double>
    nearest_of_side(const std::vector<Point<dim>> &queries,
                    const std::vector<Side<dim>>  &sides,
                    const PointStore<dim>         &points,
                    const NearestQuery            &wanted,
                    const BackgroundGrid<dim>     &grid)
    {
      // The points come with their body in front of what is wanted. Each body
      // has a tree of its own. The radius doubles as in nearest_numbers(); if
      // even the whole box holds no point of a query's body, that body is gone,
      // and the nearest of all points counts. So does the nearest of the body
      // where none is behind a surface within a few grid cells: such a surface
      // has lost its tissue.
      constexpr int near_enough = 4;
      NearestQuery  with_body{wanted.n + 1,
                             [&](const unsigned int   p,
                                 std::vector<double> &numbers) {
                               numbers.push_back(points.body(p));
                               wanted.append(p, numbers);
                             },
                             wanted.ties};
      int           largest = 0;
      for (const int n : grid.box().n())
        largest = std::max(largest, n);
      for (int radius = 1;; radius *= 2)
        {
          const PointList<dim> list =
            near_points(queries, points, with_body, grid, radius);
          std::map<unsigned int, PointList<dim>> lists; // by body
          for (unsigned int i = 0; i < list.size(); ++i)
            lists.emplace(list.row(i)[0], wanted.n)
              .first->second.add(list.ids[i],
                                 list.positions[i],
                                 ArrayView<const double>(list.row(i).data() + 1,
                                                         wanted.n));
          const bool          everywhere_looked = radius > 2 * largest;
          double              farthest          = 0.;
          std::vector<double> numbers;
          using Tree = decltype(pack_rtree_of_indices(list.positions));
          std::map<unsigned int, Tree> trees;
          for (const auto &[body, one] : lists)
            trees.emplace(body, pack_rtree_of_indices(one.positions));
          for (std::size_t q = 0; q < queries.size(); ++q)
            {
              auto tree = trees.find(sides[q].body);
              for (auto other = trees.begin();
                   everywhere_looked && trees.count(sides[q].body) == 0 &&
                   other != trees.end();
                   ++other)
                if (tree == trees.end() ||
                    nearest(queries[q], lists.at(other->first), other->second)
                        .second <
                      nearest(queries[q], lists.at(tree->first), tree->second)
                        .second)
                  tree = other;
              if (tree == trees.end())
                {
                  farthest = std::numeric_limits<double>::infinity();
                  break;
                }
              const PointList<dim> &one = lists.at(tree->first);
              auto [found, distance] =
                nearest(queries[q], one, tree->second, sides[q]);
              if (found.empty() && radius >= near_enough)
                std::tie(found, distance) =
                  nearest(queries[q], one, tree->second);
              if (found.empty())
                {
                  farthest = std::numeric_limits<double>::infinity();
                  break;
                }
              farthest = std::max(farthest, distance);
              append_wanted(found, one, wanted.ties, numbers);
            }
          const double sure = radius * grid.box().spacing();
          if (Utilities::MPI::max(farthest, grid.communicator()) <= sure ||
              everywhere_looked)
            return numbers;
        }
    }
  } // namespace

  template <int dim>
  std::vector<double>
  nearest_numbers(const std::vector<Point<dim>> &queries,
                  const PointStore<dim>         &points,
                  const NearestQuery            &wanted,
                  const BackgroundGrid<dim>     &grid,
                  const std::vector<Side<dim>>  &sides)
  {
    if (points.has_bodies() &&
        Utilities::MPI::logical_or(!sides.empty(), grid.communicator()))
      return nearest_of_side(queries, sides, points, wanted, grid);
    // The nearest point may be in any grid cell. So the radius doubles until
    // every query of every rank has found a point that is nearer than all that
    // may lie outside of the list. Mostly the first radius does. Ranks go on
    // together, since each pass is collective.
    const GridBox<dim> &box     = grid.box();
    int                 largest = 0;
    for (const int n : box.n())
      largest = std::max(largest, n);
    for (int radius = 1;; radius *= 2)
      {
        const PointList<dim> list =
          near_points(queries, points, wanted, grid, radius);
        const auto          tree = pack_rtree_of_indices(list.positions);
        std::vector<double> numbers;
        double              farthest = 0.;
        for (const Point<dim> &query : queries)
          {
            const auto [found, distance] = nearest(query, list, tree);
            farthest                     = std::max(farthest, distance);
            if (!found.empty())
              append_wanted(found, list, wanted.ties, numbers);
          }
        // A point of a grid cell outside of the radius is farther away than
        // this.
        const double sure = radius * box.spacing();
        if (Utilities::MPI::max(farthest, grid.communicator()) <= sure)
          return numbers;
        // Nothing in the box is farther than its diagonal, so there is no point
        // at all.
        AssertThrow(radius <= 2 * largest, ExcMessage("There are no cells."));
      }
  }

  MORULA_INSTANTIATE(near_points);
  MORULA_INSTANTIATE(nearest_numbers);
} // namespace Morula
