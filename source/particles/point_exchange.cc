// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.templates.h>

#include <cmath>
#include <set>

namespace Morula
{
  namespace
  {
    /** Points as one row of numbers each: id, position, their own row. */
    template <int dim>
    void
    append_row(const PointList<dim> &points,
               const std::size_t     i,
               std::vector<double>  &rows)
    {
      // A row begins with the point's id and position.
      append_flat(rows, std::tuple(points.ids[i], points.positions[i]));
      const ArrayView<const double> row = points.row(i);
      rows.insert(rows.end(), row.begin(), row.end());
    }

    /** Numbers of such a row. */
    template <int dim>
    std::size_t
    width_of_row(const unsigned int n_numbers)
    {
      return Flat<std::tuple<types::particle_index, Point<dim>>>::n + n_numbers;
    }

    template <int dim>
    void
    exchange(const std::map<unsigned int, std::vector<double>> &rows_to,
             const MPI_Comm                                     comm,
             PointList<dim>                                    &points)
    {
      // Room for all received points is made at once: this is the largest list
      // that a step may hold.
      using Head = Flat<std::tuple<types::particle_index, Point<dim>>>;
      const std::size_t width     = width_of_row<dim>(points.n_numbers);
      const auto        received  = send_records(rows_to, comm);
      std::size_t       n_numbers = 0;
      for (const auto &[rank, rows] : received)
        n_numbers += rows.size();
      points.reserve(points.size() + n_numbers / width);
      for (const auto &[rank, rows] : received)
        for (std::size_t i = 0; i < rows.size(); i += width)
          {
            const auto [id, position] = Head::read(&rows[i]);
            points.add(id, position, {&rows[i] + Head::n, points.n_numbers});
          }
    }

    /** Points that a rank sends in one go at most. All points, as at the start
     *  of a run, would be there four times: as they are, as messages to be
     *  sent, as received ones, and as what becomes of these. On 16 ranks that
     *  was the most memory that a run took (doc/performance.md, Two ranks). */
    constexpr std::size_t points_at_once = 1 << 13;

    /** How many points all ranks have for this one. Collective. */
    std::size_t
    n_points_for_this_rank(const std::vector<unsigned int> &owners,
                           const MPI_Comm                   comm)
    {
      std::map<unsigned int, std::size_t> counts;
      for (const unsigned int owner : owners)
        ++counts[owner];
      std::size_t sum = 0;
      for (const auto &[sender, n] : Utilities::MPI::some_to_some(comm, counts))
        sum += n;
      return sum;
    }
  } // namespace

  template <int dim>
  PointList<dim>
  exchange(const std::map<unsigned int, PointList<dim>> &points_to,
           const unsigned int                            n_numbers,
           const MPI_Comm                                comm)
  {
    // The points become rows of plain numbers, which travel in one message to
    // each rank.
    std::map<unsigned int, std::vector<double>> rows_to;
    for (const auto &[rank, points] : points_to)
      {
        std::vector<double> &rows = rows_to[rank];
        rows.reserve(points.size() * width_of_row<dim>(n_numbers));
        for (std::size_t i = 0; i < points.size(); ++i)
          append_row(points, i, rows);
      }
    PointList<dim> received(n_numbers);
    exchange(rows_to, comm, received);
    return received;
  }

  template <int dim>
  PointList<dim>
  by_id(const PointList<dim> &points)
  {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::sort(order.begin(), order.end(), [&](const auto a, const auto b) {
      return points.ids[a] < points.ids[b];
    });
    PointList<dim> sorted(points.n_numbers);
    sorted.reserve(points.size());
    for (const std::size_t i : order)
      sorted.add(points.ids[i],
                 points.positions[i],
                 ArrayView<const double>(points.row(i)));
    return sorted;
  }


  template <int dim>
  PointList<dim>
  of_all_ranks(const PointList<dim> &own, const MPI_Comm comm)
  {
    // All ranks get all points, sorted by id, so that they find the same in the
    // same order. For short lists only.
    PointList<dim> all(own.n_numbers);
    const auto     ids       = gather_everywhere(own.ids, comm);
    const auto     positions = gather_everywhere(own.positions, comm);
    const auto     numbers   = gather_everywhere(own.numbers, comm);
    for (unsigned int rank = 0; rank < ids.size(); ++rank)
      {
        PointList<dim> part(own.n_numbers);
        part.ids       = ids[rank];
        part.positions = positions[rank];
        part.numbers   = numbers[rank];
        all.append(part);
      }
    return by_id(all);
  }


  template <int dim>
  PointList<dim>
  send_to_owners(PointList<dim> points, const BackgroundGrid<dim> &grid)
  {
    // The owners are found first. Then points are sent in rounds of a bounded
    // number, so that no rank holds all of them as messages as well. All ranks
    // take as many rounds as the longest list asks for, since each is
    // collective. With several rounds the memory for the result is taken once.
    if (Utilities::MPI::n_mpi_processes(grid.communicator()) == 1)
      return points;
    const MPI_Comm            comm = grid.communicator();
    const unsigned int        rank = Utilities::MPI::this_mpi_process(comm);
    std::vector<unsigned int> owners;
    owners.reserve(points.size());
    for (const Point<dim> &x : points.positions)
      owners.push_back(grid.owner(grid.box().locate(x)));

    PointList<dim>    mine(points.n_numbers);
    const std::size_t n_rounds =
      Utilities::MPI::max((points.size() + points_at_once - 1) / points_at_once,
                          comm);
    if (n_rounds > 1)
      mine.reserve(n_points_for_this_rank(owners, comm));
    for (std::size_t round = 0; round < n_rounds; ++round)
      {
        std::map<unsigned int, std::vector<double>> rows_to;
        const std::size_t begin = round * points_at_once;
        const std::size_t end = std::min(begin + points_at_once, points.size());
        for (std::size_t i = begin; i < end; ++i)
          if (owners[i] == rank)
            mine.add(points.ids[i], points.positions[i], points.row(i));
          else
            append_row(points, i, rows_to[owners[i]]);
        exchange(rows_to, comm, mine);
      }
    return mine;
  }

  template <int dim>
  PointList<dim>
  halo(const PointList<dim>      &points,
       const BackgroundGrid<dim> &grid,
       const double               reach)
  {
    // A point goes to all ranks that own a grid cell within reach of its own,
    // whether or not there are positions to ask for.
    PointList<dim> others(points.n_numbers);
    if (Utilities::MPI::n_mpi_processes(grid.communicator()) == 1)
      return others;
    const int radius =
      static_cast<int>(std::ceil(reach / grid.box().spacing()));
    const unsigned int rank =
      Utilities::MPI::this_mpi_process(grid.communicator());
    // Points share grid cells, around which the owners are looked up once.
    std::map<GridIndex<dim>, std::set<unsigned int>> owners;
    std::map<unsigned int, std::vector<double>>      rows_to;
    for (std::size_t i = 0; i < points.size(); ++i)
      {
        const GridIndex<dim> index     = grid.box().locate(points.positions[i]);
        const auto [found, is_new]     = owners.try_emplace(index);
        std::set<unsigned int> &around = found->second;
        if (is_new)
          grid.box().for_neighbors(
            index, radius, [&](const unsigned int, const auto &neighbor) {
              around.insert(grid.owner(neighbor));
            });
        for (const unsigned int owner : around)
          if (owner != rank)
            append_row(points, i, rows_to[owner]);
      }
    exchange(rows_to, grid.communicator(), others);
    return others;
  }

  template <int dim>
  GridBox<dim>
  box_around(const std::vector<Point<dim>> &positions, const double spacing)
  {
    Point<dim> lower = positions.at(0), upper = positions.at(0);
    for (const Point<dim> &x : positions)
      for (unsigned int d = 0; d < dim; ++d)
        {
          lower[d] = std::min(lower[d], x[d]);
          upper[d] = std::max(upper[d], x[d]);
        }
    GridIndex<dim> n;
    for (unsigned int d = 0; d < dim; ++d)
      n[d] = static_cast<int>((upper[d] - lower[d]) / spacing) + 1;
    return {{}, n, spacing, lower};
  }


  template PointList<2>
  exchange(const std::map<unsigned int, PointList<2>> &,
           const unsigned int,
           const MPI_Comm);
  template PointList<3>
  exchange(const std::map<unsigned int, PointList<3>> &,
           const unsigned int,
           const MPI_Comm);
  MORULA_INSTANTIATE(by_id);
  MORULA_INSTANTIATE(of_all_ranks);
  MORULA_INSTANTIATE(send_to_owners);
  MORULA_INSTANTIATE(halo);
  MORULA_INSTANTIATE(box_around);
} // namespace Morula
