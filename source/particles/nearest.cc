// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/grid_box.h>
#include <morula/particles/nearest.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <limits>
#include <set>
#include <tuple>

namespace Morula
{
  namespace
  {
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

    /** Positions of the nearest points in the list, by id, and their distance:
     *  none, and infinity, if no point counts. Distances that differ by
     *  rounding only count as equal; else the choice would depend on the frame.
     *  @param side of the query, if only points on it count */
    template <int dim>
    std::pair<std::vector<unsigned int>, double>
    nearest(const Point<dim>     &query,
            const PointList<dim> &list,
            const PointBins<dim> &bins,
            const GridBox<dim>   &box,
            const Side<dim>      &side = {})
    {
      // Mostly the nearest point is within a grid spacing or two; only else the
      // whole list is looked at. Then all that are equally near are collected.
      // The order by id makes the sum of a mean independent of ranks.
      constexpr double equal    = 1. + 1e-9;
      const double     h        = box.spacing();
      double           shortest = std::numeric_limits<double>::infinity();
      const auto       counts   = [&](const unsigned int i) {
        return side.n.norm_square() == 0. || side.has(query, list.positions[i]);
      };
      const auto look_at = [&](const unsigned int i) {
        if (counts(i))
          shortest = std::min(shortest, query.distance(list.positions[i]));
      };
      for (double radius = 0.5 * h; shortest > radius && radius <= 2. * h;
           radius *= 2.)
        bins.visit_within(query, radius, look_at);
      if (std::isinf(shortest))
        for (unsigned int i = 0; i < list.size(); ++i)
          look_at(i);
      std::vector<unsigned int> found;
      if (std::isfinite(shortest))
        bins.visit_within(query, shortest * equal * equal, [&](const auto i) {
          if (counts(i) &&
              query.distance(list.positions[i]) <= shortest * equal)
            found.push_back(i);
        });
      std::sort(found.begin(),
                found.end(),
                [&](const unsigned int i, const unsigned int j) {
                  return list.ids[i] < list.ids[j];
                });
      return {found, shortest};
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
    // Grid cells around the queries, by owner, by number in order. Many queries
    // share a grid cell, which is looked at once. This rank's own points need
    // no message.
    std::set<GridIndex<dim>> with_query;
    for (const Point<dim> &query : queries)
      with_query.insert(grid.box().locate(query));
    std::set<unsigned int> numbers;
    for (const GridIndex<dim> &index : with_query)
      grid.box().for_neighbors(index,
                               radius,
                               [&](const unsigned int number, const auto &) {
                                 numbers.insert(number);
                               });
    std::map<unsigned int, std::vector<unsigned int>> near;
    for (const unsigned int number : numbers)
      near[grid.owner(number)].push_back(number);
    PointList<dim> list = points_in(near[rank], points, wanted);
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
    /** Points of one body, to be searched. */
    template <int dim>
    struct PointsOfBody
    {
      PointList<dim>                list;
      std::optional<PointBins<dim>> bins;
    };

    /** Points by their body, which is the first number of each if they have
     *  one; else all together. */
    template <int dim>
    std::map<unsigned int, PointsOfBody<dim>>
    by_body(PointList<dim> list, const bool with_body, const GridBox<dim> &box)
    {
      std::map<unsigned int, PointsOfBody<dim>> bodies;
      if (with_body)
        for (unsigned int i = 0; i < list.size(); ++i)
          {
            PointList<dim> &one = bodies[list.row(i)[0]].list;
            one.n_numbers       = list.n_numbers - 1;
            one.add(list.ids[i],
                    list.positions[i],
                    ArrayView<const double>(list.row(i).data() + 1,
                                            one.n_numbers));
          }
      else
        bodies[0].list = std::move(list);
      for (auto &[body, points] : bodies)
        points.bins.emplace(box, points.list.positions);
      return bodies;
    }

    /** The points of the query's side that are nearest, in the list of their
     *  body, and their distance: none, and infinity, if there is none in grid
     *  cells as near as @p radius. @param is_all whether these are all */
    template <int dim>
    std::tuple<const PointList<dim> *, std::vector<unsigned int>, double>
    nearest_of_side(const Point<dim>                                &query,
                    const Side<dim>                                 &side,
                    const std::map<unsigned int, PointsOfBody<dim>> &bodies,
                    const GridBox<dim>                              &box,
                    const int                                        radius,
                    const bool                                       is_all)
    {
      // If even the whole box holds no point of a query's body, that body is
      // gone, and the nearest of all points counts. So does the nearest of the
      // body where none is behind a surface within a few grid cells: such a
      // surface has lost its tissue.
      constexpr int near_enough = 4;
      const auto    look        = [&](const PointsOfBody<dim> &points,
                            const Side<dim>         &of_side = {}) {
        return nearest(query, points.list, *points.bins, box, of_side);
      };
      auto body = bodies.find(side.body);
      if (body == bodies.end() && is_all)
        body = std::min_element(bodies.begin(),
                                bodies.end(),
                                [&](const auto &a, const auto &b) {
                                  return look(a.second).second <
                                         look(b.second).second;
                                });
      if (body == bodies.end())
        return {nullptr, {}, std::numeric_limits<double>::infinity()};
      auto [found, distance] = look(body->second, side);
      if (found.empty() && radius >= near_enough)
        std::tie(found, distance) = look(body->second);
      return {&body->second.list, std::move(found), distance};
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
    // The nearest point may be in any grid cell. So the radius doubles until
    // every query of every rank has found a point that is nearer than all that
    // may lie outside of the list. Mostly the first radius does. Ranks go on
    // together, since each pass is collective. Where sides count points come
    // with their body in front of what is wanted.
    const MPI_Comm      comm = grid.communicator();
    const GridBox<dim> &box  = grid.box();
    const bool          by_side =
      points.has_bodies() && Utilities::MPI::logical_or(!sides.empty(), comm);
    NearestQuery of_point = wanted;
    if (by_side)
      of_point = {wanted.n + 1,
                  [&](const unsigned int p, std::vector<double> &numbers) {
                    numbers.push_back(points.body(p));
                    wanted.append(p, numbers);
                  },
                  wanted.ties};
    for (int radius = 1;; radius *= 2)
      {
        const std::map<unsigned int, PointsOfBody<dim>> bodies =
          by_body(near_points(queries, points, of_point, grid, radius),
                  by_side,
                  box);
        // Nothing in the box is farther than its diagonal.
        const bool is_all =
          radius > 2 * *std::max_element(box.n().begin(), box.n().end());
        std::vector<double> numbers;
        double              farthest = 0.;
        for (std::size_t q = 0; q < queries.size(); ++q)
          {
            const auto [list, found, distance] =
              nearest_of_side(queries[q],
                              by_side ? sides[q] : Side<dim>{},
                              bodies,
                              box,
                              radius,
                              is_all);
            farthest = std::max(farthest, distance);
            if (found.empty())
              break;
            // What is wanted of the points found, or of the first one.
            const std::size_t n = wanted.ties == Ties::mean ? found.size() : 1;
            for (unsigned int i = 0; i < wanted.n; ++i)
              {
                double sum = 0.;
                for (std::size_t k = 0; k < n; ++k)
                  sum += list->row(found[k])[i];
                numbers.push_back(sum / n);
              }
          }
        // A point of a grid cell outside of the radius is farther away than
        // this.
        if (Utilities::MPI::max(farthest, comm) <= radius * box.spacing())
          return numbers;
        AssertThrow(by_side || !is_all, ExcMessage("There are no cells."));
        if (is_all)
          return numbers;
      }
  }

  MORULA_INSTANTIATE(near_points);
  MORULA_INSTANTIATE(nearest_numbers);


  namespace
  {
    /** Distance from which on cells do not count, in grid spacings. */
    constexpr double reach = 0.75;

    /** Added to the variance of the positions, which is about 0.05 in units of
     *  the squared reach: cells that are all about equally far from the surface
     *  say nothing of a slope. */
    constexpr double least_variance = 1e-3;

    /** Changes weights that fall off with the distance so that they reproduce
     *  linear functions: doc/theory.md (4.6c). @param s ways from the place to
     *  the cells, in units of the reach */
    template <int dim>
    void
    make_linear(const std::vector<Tensor<1, dim>> &s, std::vector<double> &w)
    {
      // The weights w get a factor that is linear in s, such that Σ ω s = 0:
      // with it the value at the place is that of the plane through the cells'
      // values.
      double         sum = 0.;
      Tensor<1, dim> mean;
      for (std::size_t i = 0; i < s.size(); ++i)
        {
          sum += w[i];
          mean += w[i] * s[i];
        }
      mean /= sum;
      Tensor<2, dim> variance(least_variance * unit_symmetric_tensor<dim>());
      for (std::size_t i = 0; i < s.size(); ++i)
        variance += outer_product(w[i] / sum * (s[i] - mean), s[i] - mean);
      const Tensor<1, dim> slope = invert(variance) * mean;
      for (std::size_t i = 0; i < s.size(); ++i)
        w[i] *= (1. - slope * (s[i] - mean)) / sum;
    }
  } // namespace


  template <int dim>
  Surroundings<dim>::Surroundings(const std::vector<Point<dim>> &places,
                                  const Tissue<dim>             &tissue,
                                  const std::vector<Side<dim>>  &sides)
    : comm(tissue.communicator())
  {
    // Cells within reach are at most in the neighbouring grid cells, of this or
    // another rank; they come with their volumes and where they are. Bins find
    // those around each place, in an order that does not depend on ranks. Their
    // weights fall to zero at the reach, so that no cell enters or leaves with
    // a jump, and are made linear after that, doc/theory.md (4.6c). A place
    // without cells keeps an empty list. In the end the ranks are told which of
    // their cells count here.
    const Cells<dim>          &cells  = tissue.cells();
    const BackgroundGrid<dim> &grid   = tissue.grid();
    const double               radius = reach * grid.box().spacing();
    const unsigned int         rank   = Utilities::MPI::this_mpi_process(comm);
    const auto append = [&](const unsigned int p, std::vector<double> &list) {
      list.insert(list.end(),
                  {cells[p].volume(), 1. * cells.body(p), 1. * rank, 1. * p});
    };
    const PointList<dim> near =
      near_points(places, cells, {4, append, Ties::lowest_id}, grid, 1);
    const PointBins<dim>        bins(grid.box(), near.positions);
    std::vector<std::size_t>    around;
    std::vector<Tensor<1, dim>> ways;
    std::vector<double>         weights;
    shares.resize(places.size());
    for (std::size_t place = 0; place < places.size(); ++place)
      {
        const Point<dim> &x = places[place];
        around.clear();
        ways.clear();
        weights.clear();
        // Rounding must not leave out a cell that has a weight.
        bins.visit_within(x, radius * (1. + 1e-9), [&](const auto i) {
          const Tensor<1, dim> s    = (near.positions[i] - x) / radius;
          const double         fall = 1. - s.norm_square();
          if (fall <= 0. ||
              (!sides.empty() && (near.row(i)[1] != sides[place].body ||
                                  !sides[place].has(x, near.positions[i]))))
            return;
          around.push_back(i);
          ways.push_back(s);
          weights.push_back(fall * fall * near.row(i)[0]);
        });
        if (!around.empty())
          make_linear(ways, weights);
        shares[place].reserve(around.size());
        for (std::size_t k = 0; k < around.size(); ++k)
          shares[place].emplace_back(around[k], weights[k]);
      }

    std::vector<bool> counts(near.size());
    for (const auto &of_place : shares)
      for (const auto &[i, weight] : of_place)
        counts[i] = true;
    // Answers come in the order of the ranks, and of the cells on each.
    using Cell = std::array<unsigned int, 3>; // rank, number there, place here
    std::vector<Cell> list;
    for (unsigned int i = 0; i < near.size(); ++i)
      if (counts[i])
        list.push_back(Cell{{static_cast<unsigned int>(near.row(i)[2]),
                             static_cast<unsigned int>(near.row(i)[3]),
                             i}});
    std::sort(list.begin(), list.end());
    std::map<unsigned int, std::vector<unsigned int>> wanted;
    std::vector<std::size_t>                          answer(near.size());
    for (std::size_t k = 0; k < list.size(); ++k)
      {
        wanted[list[k][0]].push_back(list[k][1]);
        answer[list[k][2]] = k;
      }
    for (auto &of_place : shares)
      for (auto &[i, weight] : of_place)
        i = answer[i];
    asked = send_records(wanted, comm);
  }

  template <int dim>
  std::vector<unsigned int>
  Surroundings<dim>::asked_here() const
  {
    std::vector<unsigned int> result;
    for (const auto &[rank, list] : asked)
      result.insert(result.end(), list.begin(), list.end());
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  template class Surroundings<2>;
  template class Surroundings<3>;
} // namespace Morula
