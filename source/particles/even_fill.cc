// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/particles/even_spread.h>

#include <cmath>
#include <map>
#include <set>
#include <unordered_map>

namespace Morula
{
  namespace
  {
    /** The least fill of grid cells inside the tissue. A grid cell that the
     *  surface cuts has room that belongs to no cell: its cells must not be
     *  taken to leave gaps. */
    constexpr double nearly_full = 0.6;

    /** A grid cell that is nearly full, or more. */
    template <int dim>
    struct FullGridCell
    {
      GridIndex<dim> grid_cell;
      double         fill;
    };

    /** The nearly full grid cells in and around those that this rank owns now,
     *  by their numbers in the box of the time of @p occupancy. Collective. */
    template <int dim>
    std::unordered_map<unsigned int, double>
    nearly_full_around(const Occupancy<dim>      &occupancy,
                       const BackgroundGrid<dim> &grid)
    {
      // Fills are known by grid cell of the time of the occupancy, by the
      // owners of that time. Cells are asked for on the ranks that own their
      // grid cells now. So each owner sends its nearly full grid cells to the
      // ranks that own them or a neighbour now.
      std::map<unsigned int, std::vector<FullGridCell<dim>>> by_rank;
      for (const unsigned int number : occupancy.own())
        if (const double fill = occupancy.fill(number); fill >= nearly_full)
          {
            const GridIndex<dim>   index = occupancy.nodes().index(number);
            std::set<unsigned int> ranks;
            grid.box().for_neighbors(
              index, 1, [&](const unsigned int, const GridIndex<dim> &other) {
                ranks.insert(grid.owner(other));
              });
            for (const unsigned int rank : ranks)
              by_rank[rank].push_back({index, fill});
          }
      std::unordered_map<unsigned int, double> fills;
      for (const auto &[sender, list] :
           send_records(by_rank, grid.communicator()))
        for (const FullGridCell<dim> &one : list)
          fills[occupancy.window().whole().number(one.grid_cell)] += one.fill;
      return fills;
    }

    /** The nearly full grid cells whose neighbours are nearly full, too.
     *  GridBox counts a grid cell among its own neighbours. */
    template <int dim>
    std::unordered_map<unsigned int, double>
    inside(const std::unordered_map<unsigned int, double> &fills,
           const GridBox<dim>                             &box)
    {
      std::unordered_map<unsigned int, double> result;
      for (const auto &[number, fill] : fills)
        {
          unsigned int n_full = 0;
          box.for_neighbors(box.index(number),
                            1,
                            [&](const unsigned int other, const auto &) {
                              n_full += fills.count(other);
                            });
          // At the edge of the box a grid cell has fewer neighbours, and is not
          // inside.
          if (n_full == Utilities::fixed_power<dim>(3u))
            result[number] = fill;
        }
      return result;
    }
  } // namespace

  template <int dim>
  void
  relax_volumes_to_space(Tissue<dim>          &tissue,
                         const Occupancy<dim> &occupancy,
                         const double          part,
                         const unsigned int    body)
  {
    const GridBox<dim> &box = occupancy.window().whole();
    const auto          fills =
      inside(nearly_full_around(occupancy, tissue.grid()), box);
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const GridIndex<dim> index = box.locate(tissue.cells().position(p));
        if (!box.contains(index) ||
            (!tissue.cells().has_parts() && tissue.cells().body(p) != body))
          continue;
        // Where cells overlap F becomes smaller, where they leave gaps it
        // becomes larger: doc/theory.md (6.9c). The exponent is that of one
        // direction.
        const auto found = fills.find(box.number(index));
        if (found == fills.end())
          continue;
        const CellView<dim, double> cell = tissue.cell(p);
        cell.set(cell.columns().deformation,
                 std::pow(found->second, -part / dim) * cell.F());
      }
  }

  MORULA_INSTANTIATE(relax_volumes_to_space);
} // namespace Morula
