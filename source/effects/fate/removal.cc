// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/effects/fate/removal.h>
#include <morula/particles/detached_points.h>
#include <morula/particles/nearest.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

namespace Morula
{
  namespace
  {
    /**
     * Gives what these cells of this rank leave to the nearest cells that stay,
     * of whichever rank: doc/theory.md (6.9d). Collective.
     * @param gone    numbers of this rank's cells that go, sorted
     * @param carried the columns of the fields
     * @param left    of each cell that goes without another one in its grid
     *   cell its position, µm, and its amounts of the fields, times µm^dim
     */
    template <int dim>
    void
    give_to_nearest(Tissue<dim>                       &tissue,
                    const std::vector<unsigned int>   &gone,
                    const std::vector<Column<double>> &carried,
                    const std::vector<double>         &left)
    {
      // All ranks get what all leave, which is rare and little. Each looks for
      // its own nearest cell that stays; the nearest of all ranks counts, and
      // of cells that are equally near that with the lowest id, so that the
      // number of ranks does not matter.
      const MPI_Comm      comm = tissue.communicator();
      std::vector<double> all;
      for (const auto &list : gather_everywhere(left, comm))
        all.insert(all.end(), list.begin(), list.end());
      const std::size_t length = dim + carried.size();
      const std::size_t n      = all.size() / length;
      if (n == 0)
        return;

      const Cells<dim>         &cells = tissue.cells();
      std::vector<unsigned int> staying;
      std::vector<Point<dim>>   positions;
      for (unsigned int p = 0; p < cells.size(); ++p)
        if (!std::binary_search(gone.begin(), gone.end(), p))
          {
            staying.push_back(p);
            positions.push_back(cells.position(p));
          }
      const auto                tree = pack_rtree_of_indices(positions);
      std::vector<double>       distance(n, std::numeric_limits<double>::max());
      std::vector<double>       id(n, std::numeric_limits<double>::max());
      std::vector<unsigned int> nearest(n);
      constexpr unsigned int    most_alike = 12; // in a lattice, in 3-D
      for (std::size_t k = 0; k < n; ++k)
        {
          Point<dim> x;
          for (unsigned int d = 0; d < dim; ++d)
            x[d] = all[k * length + d];
          std::vector<std::size_t> found;
          tree.query(boost::geometry::index::nearest(x, most_alike),
                     std::back_inserter(found));
          for (const std::size_t i : found)
            {
              const double way = x.distance(positions[i]);
              const double its = cells.id(staying[i]);
              if (way < distance[k] || (way == distance[k] && its < id[k]))
                {
                  distance[k] = way;
                  id[k]       = its;
                  nearest[k]  = staying[i];
                }
            }
        }
      std::vector<double> least(n), lowest(id);
      Utilities::MPI::min(distance, comm, least);
      for (std::size_t k = 0; k < n; ++k)
        if (distance[k] > least[k])
          lowest[k] = std::numeric_limits<double>::max();
      Utilities::MPI::min(lowest, comm, lowest);
      for (std::size_t k = 0; k < n; ++k)
        if (distance[k] == least[k] && id[k] == lowest[k] &&
            distance[k] < std::numeric_limits<double>::max())
          {
            const CellView<dim, double> cell = tissue.cell(nearest[k]);
            for (std::size_t c = 0; c < carried.size(); ++c)
              cell.set(carried[c],
                       cell.get(carried[c]) +
                         all[k * length + dim + c] / cell.volume());
          }
    }

    /**
     * Hands the volumes of shrunken cells that go to those that stay in their
     * grid cell: without it each would leave a hole, and the tissue would
     * become ever more porous. Where cells go unshrunken a gap is meant.
     */
    template <int dim>
    void
    hand_on(Tissue<dim>                       &tissue,
            const Fates<dim>                  &fates,
            const std::vector<unsigned int>   &gone,
            const std::vector<Column<double>> &carried)
    {
      // The loop is over the grid cells of this rank. A first pass over the
      // cells of each adds up the volume of those that go shrunken, with the
      // amounts of the fields in it, and that of those that stay. A second one
      // stretches the cells, so that the volume is conserved and the tissue
      // draws together in the next step.
      const Cells<dim> &cells = tissue.cells();
      // Cells are stored grid cell by grid cell, and `gone` is sorted, so one
      // pointer runs along. All cells of a grid cell are on one rank: nothing
      // is sent.
      std::vector<double> left;
      auto                next = gone.begin();
      for (const auto &grid_cell : cells.grid_cells())
        {
          const auto          first = next;
          double              from = 0., to = 0.;          // µm^dim
          std::vector<double> amounts(carried.size(), 0.); // of those that go
          const std::size_t   n_left = left.size();
          for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
            if (next != gone.end() && *next == p)
              {
                if (std::any_of(fates.deadly.begin(),
                                fates.deadly.end(),
                                [&](const Dies<dim> *const dies) {
                                  return dies->shrinks(cells[p]);
                                }))
                  {
                    from += cells.volume(p);
                    append_flat(left, cells.position(p));
                    for (std::size_t k = 0; k < carried.size(); ++k)
                      {
                        const double amount =
                          cells.volume(p) * cells[p].get(carried[k]);
                        left.push_back(amount);
                        amounts[k] += amount;
                      }
                  }
                ++next;
              }
            else if (first != gone.end() && *first < grid_cell.end)
              to += cells.volume(p);
          // Where none stays, cells elsewhere get what they leave.
          if (to > 0.)
            left.resize(n_left);
          if (from == 0. || to == 0.)
            continue;
          // This is doc/theory.md (6.9b). The ratio has a limit of 2: a single
          // cell that stays among many that go would be blown up.
          const double ratio   = 1. + std::min(1., from / to);
          const double stretch = std::pow(ratio, 1. / dim);
          for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
            {
              // Cells that go are stretched, too; they are taken out
              // afterwards.
              const CellView<dim, double> cell = tissue.cell(p);
              cell.set(cell.columns().deformation, stretch * cell.F());
              // The amount of each transient field goes to those that stay, and
              // their larger volume dilutes it: doc/theory.md (6.9d).
              for (std::size_t k = 0; k < carried.size(); ++k)
                cell.set(carried[k],
                         (cell.get(carried[k]) + amounts[k] / to) / ratio);
            }
        }
      if (!carried.empty())
        give_to_nearest(tissue, gone, carried, left);
    }

    /** Adds the boundary points of bodies that have no cell left to a sorted
     *  list of points of this rank. Collective. */
    template <int dim>
    void
    add_points_of_dead_bodies(const Tissue<dim>         &tissue,
                              std::vector<unsigned int> &list)
    {
      const BoundaryPoints<dim> &points = tissue.boundary_points();
      if (!points.has_bodies())
        return;
      std::vector<double> cells(n_bodies(tissue), 0.);
      for (const unsigned int body : tissue.cells().bodies())
        ++cells[body];
      Utilities::MPI::sum(cells, tissue.communicator(), cells);
      for (unsigned int p = 0; p < points.size(); ++p)
        if (cells[points.body(p)] == 0.)
          list.push_back(p);
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    }

    /** Boundary points of this rank that the removal of these cells leaves
     *  without a cell within reach. Points that had none before are let be:
     *  they are held where they are. Takes the cells out. */
    template <int dim>
    std::vector<unsigned int>
    take_out(Tissue<dim> &tissue, const std::vector<unsigned int> &cells)
    {
      const std::vector<unsigned int> before = detached_points(tissue);
      tissue.remove(cells, {});
      const std::uint64_t n =
        Utilities::MPI::sum<std::uint64_t>(tissue.cells().size(),
                                           tissue.communicator());
      std::vector<unsigned int> left;
      // Without any cell in the whole tissue no point has anything within
      // reach.
      if (n == 0)
        {
          left.resize(tissue.boundary_points().size());
          std::iota(left.begin(), left.end(), 0u);
          return left;
        }
      std::vector<unsigned int> after = detached_points(tissue);
      add_points_of_dead_bodies(tissue, after);
      std::set_difference(after.begin(),
                          after.end(),
                          before.begin(),
                          before.end(),
                          std::back_inserter(left));
      return left;
    }

    /** The fate that strikes a living cell at @p t (day) such that it is to be
     *  removed then, or null. @throws InputError */
    template <int dim>
    const Dies<dim> *
    takes_at_once(const Fates<dim>       &fates,
                  const PresentCell<dim> &cell,
                  const double            t)
    {
      for (const Dies<dim> *const fate : fates.deadly)
        {
          if (!fate->strikes(cell, t))
            continue;
          // The death is tried on a copy: whether the cell is removed at once
          // follows from what its death writes into the row.
          std::vector<double>         row(cell.cell().row().begin(),
                                  cell.cell().row().end());
          const CellView<dim, double> after(make_array_view(row),
                                            cell.cell().columns());
          std::vector<CellEvent>      events;
          fate->strike(cell, after, t, events);
          // The first fate that strikes a cell has it, whatever others would
          // do.
          return fate->is_due_for_removal(after, t) ? fate : nullptr;
        }
      return nullptr;
    }

    /** Boundary points of this rank whose nearest cell is one of these, by
     * their positions in the store. Collective. */
    template <int dim>
    std::vector<unsigned int>
    points_of(const Tissue<dim> &tissue, const std::vector<unsigned int> &cells)
    {
      // The nearest cell may be on another rank, so each cell's answer is given
      // as a number that can be sent: 1 if it goes.
      std::vector<double> goes(tissue.cells().size(), 0.);
      for (const unsigned int p : cells)
        goes[p] = 1.;
      const auto nearest = nearest_values(
        tissue.boundary_points().positions(),
        tissue.cells(),
        [&goes](const unsigned int p) { return goes[p]; },
        Ties::lowest_id,
        tissue.grid(),
        tissue.boundary_points().sides());
      std::vector<unsigned int> list;
      for (unsigned int p = 0; p < nearest.size(); ++p)
        if (nearest[p] > 0.)
          list.push_back(p);
      return list;
    }

    /** Cells, by their places in the store, and what takes each at once. */
    template <int dim>
    using Taken = std::vector<std::pair<unsigned int, const Dies<dim> *>>;

    /** Living cells of this rank that are removed at once in the reader's
     * state. Collective. @throws InputError on all ranks */
    template <int dim>
    Taken<dim>
    cells_taken(const Tissue<dim>     &tissue,
                const Fates<dim>      &fates,
                const CellReader<dim> &reader)
    {
      Taken<dim> list;
      everywhere(tissue.communicator(), [&]() {
        for (unsigned int p = 0; p < tissue.cells().size(); ++p)
          if (!fates.is_dead(tissue.cells()[p]))
            if (const Dies<dim> *fate = takes_at_once(
                  fates, present_cell(tissue, p, reader), reader.time))
              list.emplace_back(p, fate);
      });
      return list;
    }

    /** Living cells of this rank that a condition takes at the end of a step.
     *  Where a condition has no value nothing is taken, and the next step
     *  reports the error. Collective. */
    template <int dim>
    Taken<dim>
    cells_to_cut(const Tissue<dim>     &tissue,
                 const Fates<dim>      &fates,
                 const CellReader<dim> &reader)
    {
      if (std::none_of(fates.deadly.begin(),
                       fates.deadly.end(),
                       [](const auto &dies) { return dies->may_strike(); }))
        return {};
      try
        {
          return cells_taken(tissue, fates, reader);
        }
      catch (const InputError &)
        {
          return {};
        }
    }
  } // namespace


  template <int dim>
  std::vector<CellEvent>
  remove_dead_cells(Tissue<dim>                       &tissue,
                    const CellDevelopment<dim>        &development,
                    const double                       t,
                    const std::vector<Column<double>> &carried)
  {
    // There are four passes. Conditions that take cells at once strike at the
    // end of the step. Then all cells that are due are collected, with their
    // events. Their volume is handed to those that stay, while all are still in
    // the store. At last cells are taken out, and the boundary points that
    // stand alone after it; whether this is done is decided by all ranks
    // together, as it is collective.
    const Cells<dim>         &cells  = tissue.cells();
    const Fates<dim>         &fates  = development.fates();
    const CellReader<dim>     reader = development.reader(t);
    std::vector<unsigned int> gone;
    std::vector<CellEvent>    events;
    for (const auto &[p, fate] : cells_to_cut(tissue, fates, reader))
      fate->strike(present_cell(tissue, p, reader), tissue.cell(p), t, events);
    for (unsigned int p = 0; p < cells.size(); ++p)
      for (const Dies<dim> *const fate : fates.deadly)
        if (fate->is_due_for_removal(cells[p], t))
          {
            const unsigned int type = present_cell(tissue, p, reader).type();
            // The list is sorted by the place in the store, on which hand_on()
            // relies.
            gone.push_back(p);
            events.push_back({fate->removal_time(cells[p]),
                              cells.id(p),
                              CellEvent::removal,
                              type,
                              type});
            break;
          }
    hand_on(tissue, fates, gone, carried);
    if (Utilities::MPI::max(gone.size(), tissue.communicator()) > 0)
      tissue.remove({}, take_out(tissue, gone));
    return events;
  }


  template <int dim>
  std::vector<CellEvent>
  carve(Tissue<dim> &tissue, const CellDevelopment<dim> &development)
  {
    // This is done once, before the first row of the outputs. Points leave with
    // their nearest cell, for which both must still be there. So cells and
    // points are removed in one call, and no volume is handed on: the gap is
    // meant.
    const CellReader<dim>     reader = development.reader(0.);
    std::vector<unsigned int> gone;
    std::vector<CellEvent>    events;
    for (const auto &[p, fate] :
         cells_taken(tissue, development.fates(), reader))
      {
        const PresentCell<dim> cell = present_cell(tissue, p, reader);
        gone.push_back(p);
        fate->strike(cell, tissue.cell(p), 0., events);
        events.push_back(
          {0., cell.id(), CellEvent::removal, cell.type(), cell.type()});
      }
    if (Utilities::MPI::logical_or(!gone.empty(), tissue.communicator()))
      tissue.remove(gone, points_of(tissue, gone));
    return events;
  }

  MORULA_INSTANTIATE(carve);
  MORULA_INSTANTIATE(remove_dead_cells);
} // namespace Morula
