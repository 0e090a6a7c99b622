// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/particles/point_exchange.h>
#include <morula/particles/point_store.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace Morula
{
  namespace
  {
    /** The canonical order of points: by grid cell, then by id. */
    template <int dim>
    std::vector<unsigned int>
    canonical_order(const PointList<dim> &points, const GridBox<dim> &box)
    {
      // Sorting small records is faster than sorting an index with look-ups.
      std::vector<std::tuple<unsigned int, types::particle_index, unsigned int>>
        places; // numbers of grid cells, ids, and i
      places.reserve(points.size());
      for (unsigned int i = 0; i < points.size(); ++i)
        places.emplace_back(box.number(box.locate(points.positions[i])),
                            points.ids[i],
                            i);
      std::sort(places.begin(), places.end());
      std::vector<unsigned int> order;
      order.reserve(places.size());
      for (const auto &place : places)
        order.push_back(std::get<2>(place));
      return order;
    }
  } // namespace

  template <int dim>
  void
  PointStore<dim>::insert(PointList<dim>             points,
                          const BackgroundGrid<dim> &grid)
  {
    // A rank without points may not have set n_numbers.
    if (points.size() == 0)
      points.n_numbers = n_numbers;
    points = send_to_owners(std::move(points), grid);
    insert_own(points, grid);
  }

  template <int dim>
  void
  PointStore<dim>::insert_own(const PointList<dim>      &points,
                              const BackgroundGrid<dim> &grid)
  {
    // Points that are inserted into a store with points lie behind these in
    // memory.
    if (!order.empty())
      n_disordered += points.size();
    reserve(order.size() + points.size());
    const GridBox<dim> &box = grid.box();
    // Points come in the order of grid cells, so each grid cell is looked up
    // once.
    unsigned int                               last = box.size();
    typename BackgroundGrid<dim>::CellIterator grid_cell;
    for (const unsigned int i : canonical_order(points, box))
      {
        const GridIndex<dim> index = box.locate(points.positions[i]);
        if (const unsigned int number = box.number(index); number != last)
          {
            grid_cell = grid.grid_cell(number);
            last      = number;
          }
        handler.insert_particle(points.positions[i],
                                box.unit_position(points.positions[i], index),
                                points.ids[i],
                                grid_cell,
                                points.row(i));
      }
    sort(grid);
  }

  template <int dim>
  void
  PointStore<dim>::move(const std::vector<Point<dim>> &positions,
                        const BackgroundGrid<dim>     &grid)
  {
    // Points that stay in their grid cell get their new position where they
    // are. The others are taken out and inserted again, perhaps on another
    // rank: they may have gone any distance, which the ParticleHandler's own
    // sorting would not allow.
    AssertDimension(positions.size(), order.size());
    const GridBox<dim>       &box = grid.box();
    PointList<dim>            leaving(n_numbers);
    std::vector<unsigned int> left;
    for (const GridCell &cell : grid_cells_)
      {
        const GridIndex<dim> index = box.index(cell.number);
        for (unsigned int p = cell.begin; p < cell.end; ++p)
          if (const Point<dim> &x = positions[p]; box.locate(x) == index)
            {
              order[p]->set_location(x);
              order[p]->set_reference_location(box.unit_position(x, index));
            }
          else
            {
              leaving.add(id(p), x, row(p));
              left.push_back(p);
            }
      }
    replace(left, leaving, grid);
  }

  template <int dim>
  void
  PointStore<dim>::take_out(const std::vector<unsigned int> &removed)
  {
    // One call removes all: deal.II counts the points of all ranks in each.
    std::vector<Iterator> particles;
    particles.reserve(removed.size());
    for (const unsigned int p : removed)
      particles.push_back(order[p]);
    handler.remove_particles(particles);
  }

  template <int dim>
  void
  PointStore<dim>::reserve(const std::size_t n)
  {
    // deal.II's pool would double its memory when it is full, and for a moment
    // hold three times what a growing tissue needs. An eighth more than needed
    // is enough, as what is not used yet takes no memory.
    if (n <= capacity)
      return;
    capacity = n + n / 8;
    handler.get_property_pool().reserve(capacity);
  }

  template <int dim>
  void
  PointStore<dim>::sort(const BackgroundGrid<dim> &grid)
  {
    // The handler has a list of points for each of its cells. Taken by number
    // of the grid cells and sorted by part and id inside each, they are in the
    // canonical order, which all loops and sums use.
    grid_cells_.clear();
    order.clear();
    for (const auto &[number, cell] : grid.owned_grid_cells())
      {
        const unsigned int begin = order.size();
        auto               range = handler.particles_in_cell(cell);
        for (auto point = range.begin(); point != range.end(); ++point)
          order.push_back(point);
        if (order.size() == begin)
          continue;
        const Column<unsigned int> &column =
          part_column.exists() ? part_column : body_column;
        const auto part_of = [&](const Iterator &point) {
          return column.exists() ? column.get(ArrayView<const double>(
                                     point->get_properties())) :
                                   0;
        };
        std::sort(order.begin() + begin,
                  order.end(),
                  [&](const Iterator &a, const Iterator &b) {
                    return std::make_pair(part_of(a), a->get_id()) <
                           std::make_pair(part_of(b), b->get_id());
                  });
        for (unsigned int p = begin; p < order.size(); ++p)
          if (const unsigned int part = part_of(order[p]);
              p > begin && grid_cells_.back().part == part)
            ++grid_cells_.back().end;
          else
            grid_cells_.push_back({number, p, p + 1, part});
      }
  }

  template <int dim>
  std::pair<GridIndex<dim>, GridIndex<dim>>
  extent(const std::vector<const std::vector<Point<dim>> *> &positions,
         const BackgroundGrid<dim>                          &grid)
  {
    // The largest coordinates, and the largest negated ones, so that one
    // reduction gives both bounds.
    std::vector<int> bounds(2 * dim, std::numeric_limits<int>::lowest());
    for (const auto *list : positions)
      for (const Point<dim> &x : *list)
        {
          const GridIndex<dim> index = grid.locate(x);
          for (unsigned int d = 0; d < dim; ++d)
            {
              bounds[d]       = std::max(bounds[d], index[d]);
              bounds[dim + d] = std::max(bounds[dim + d], -index[d]);
            }
        }
    Utilities::MPI::max(bounds, grid.communicator(), bounds);
    GridIndex<dim> first, last;
    for (unsigned int d = 0; d < dim; ++d)
      {
        last[d]  = bounds[d];
        first[d] = -bounds[dim + d];
      }
    return {first, last};
  }

  template <int dim>
  GridCellCounts
  count_points(const std::vector<Point<dim>> &positions,
               const BackgroundGrid<dim>     &grid)
  {
    GridCellCounts counts;
    for (const Point<dim> &x : positions)
      {
        const unsigned int number = grid.box().number(grid.box().locate(x));
        // In a store's order points of one grid cell follow one another, so
        // most counts are complete before they are sent.
        if (counts.empty() || counts.back().number != number)
          counts.push_back({number, 0});
        ++counts.back().n;
      }
    return grid.sum_at_owners(counts);
  }

  template class PointStore<2>;
  template class PointStore<3>;
  MORULA_INSTANTIATE(extent);
  MORULA_INSTANTIATE(count_points);
} // namespace Morula
