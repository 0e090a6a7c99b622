// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/even_fill.h>

#include <cmath>

namespace Morula
{
  namespace
  {
    /** Least fill of grid cells inside the tissue. */
    constexpr double nearly_full = 0.6;

    /** Whether the grid cell and all its neighbours are nearly full: the
     *  neighbours of GridBox are with the grid cell itself. */
    template <int dim>
    bool
    is_inside(const Occupancy<dim> &occupancy, const GridIndex<dim> &index)
    {
      unsigned int n_full = 0;
      occupancy.box().for_neighbors(
        index, 1, [&](const unsigned int number, const auto &) {
          n_full += occupancy.fill(number) >= nearly_full;
        });
      // at the edge of the box there are fewer
      return n_full == Utilities::fixed_power<dim>(3u);
    }
  } // namespace

  template <int dim>
  void
  even_out_fill(Tissue<dim>          &tissue,
                const Occupancy<dim> &occupancy,
                const double          part)
  {
    const GridBox<dim> &box = occupancy.box();
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      {
        const GridIndex<dim> index = box.locate(tissue.cells().position(p));
        if (!box.contains(index) || !is_inside(occupancy, index))
          continue;
        const double                fill = occupancy.fill(box.number(index));
        const CellView<dim, double> cell = tissue.cell(p);
        cell.set(cell.columns().deformation,
                 std::pow(fill, -part / dim) * cell.F());
      }
  }

  template void
  even_out_fill(Tissue<2> &, const Occupancy<2> &, const double);
  template void
  even_out_fill(Tissue<3> &, const Occupancy<3> &, const double);
} // namespace Morula
