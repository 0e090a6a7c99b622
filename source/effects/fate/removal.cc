// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/removal.h>
#include <morula/particles/detached_points.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>

namespace Morula
{
  namespace
  {
    /**
     * Hands the volumes of shrunken cells that go to those that stay in their
     * grid cell: without it each would leave a hole, and the tissue would
     * become ever more porous. Where cells go unshrunken a gap is meant.
     */
    template <int dim>
    void
    hand_on(Tissue<dim>                     &tissue,
            const Death<dim>                &death,
            const std::vector<unsigned int> &gone)
    {
      const Cells<dim> &cells = tissue.cells();
      auto              next  = gone.begin();
      for (const auto &grid_cell : cells.grid_cells())
        {
          const auto first = next;
          double     from = 0., to = 0.; // µm^dim
          for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
            if (next != gone.end() && *next == p)
              {
                if (death.shrinks(cells[p]))
                  from += cells.volume(p);
                ++next;
              }
            else if (first != gone.end() && *first < grid_cell.end)
              to += cells.volume(p);
          if (from == 0. || to == 0.)
            continue;
          // doc/theory.md (6.9b)
          const double stretch =
            std::pow(1. + std::min(1., from / to), 1. / dim);
          for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
            {
              const CellView<dim, double> cell = tissue.cell(p);
              cell.set(cell.columns().deformation, stretch * cell.F());
            }
        }
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
      if (n == 0)
        {
          left.resize(tissue.boundary_points().size());
          std::iota(left.begin(), left.end(), 0u);
          return left;
        }
      const std::vector<unsigned int> after = detached_points(tissue);
      std::set_difference(after.begin(),
                          after.end(),
                          before.begin(),
                          before.end(),
                          std::back_inserter(left));
      return left;
    }
  } // namespace

  template <int dim>
  std::vector<CellEvent>
  remove_dead_cells(Tissue<dim>                &tissue,
                    const CellDevelopment<dim> &development,
                    const double                t)
  {
    const Cells<dim>         &cells  = tissue.cells();
    const CellReader<dim>     reader = development.reader(t);
    std::vector<unsigned int> gone;
    std::vector<CellEvent>    events;
    for (unsigned int p = 0; p < cells.size(); ++p)
      if (development.death()->is_due_for_removal(cells[p], t))
        {
          const unsigned int type =
            PresentCell<dim>(cells[p], cells.id(p), cells.position(p), reader)
              .type();
          gone.push_back(p);
          events.push_back({development.death()->removal_time(cells[p]),
                            cells.id(p),
                            CellEvent::Kind::removal,
                            type,
                            type});
        }
    hand_on(tissue, *development.death(), gone);
    if (Utilities::MPI::max(gone.size(), tissue.communicator()) > 0)
      tissue.remove({}, take_out(tissue, gone));
    return events;
  }

  template std::vector<CellEvent>
  remove_dead_cells(Tissue<2> &, const CellDevelopment<2> &, const double);
  template std::vector<CellEvent>
  remove_dead_cells(Tissue<3> &, const CellDevelopment<3> &, const double);
} // namespace Morula
