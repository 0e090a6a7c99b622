// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/fields/field_solve.h>

#include <deal.II/base/mpi.h>

#include <vector>

// This file has what FieldSolver says of fields that nothing takes from.

namespace Morula
{
  template <int dim>
  unsigned int
  FieldSolver<dim>::check_sink(const Field<dim> &field) const
  {
    // Nothing diffuses from piece to piece, so each needs a sink of its own.
    // The sums of all ranks are added up, as a piece may run through several:
    // what takes from the field, what gives to it, and the number of cells.
    const unsigned int  n = space.n_pieces();
    std::vector<double> sums(3 * n, 0.);
    for (unsigned int c = 0; c < space.grid_cells().size(); ++c)
      {
        const auto   &grid_cell = space.grid_cells()[c];
        double *const of =
          &sums[3 * space.piece(grid_cell.number, grid_cell.part)];
        for (unsigned int k = equation.cell_places.offsets[c];
             k < equation.cell_places.offsets[c + 1];
             ++k)
          {
            of[0] += equation.cells[k].volume * equation.cells[k].rate;
            of[1] += equation.cells[k].volume * equation.cells[k].load;
            of[2] += 1.;
          }
        if (equation.surface.empty())
          continue;
        for (unsigned int k = equation.surface_places.offsets[c];
             k < equation.surface_places.offsets[c + 1];
             ++k)
          {
            const FieldAtSurface<dim> &point = equation.surface[k];
            of[0] += point.weight + point.fixed;
            of[1] += point.inflow;
          }
      }
    Utilities::MPI::sum(sums, tissue.communicator(), sums);
    unsigned int n_nothing = 0, n_determined = 0;
    bool         grows = false;
    for (unsigned int p = 0; p < n; ++p)
      {
        const bool has_cells = sums[3 * p + 2] > 0., sinks = sums[3 * p] > 0.;
        n_determined += sinks;
        n_nothing += has_cells && !sinks;
        grows = grows || (has_cells && !sinks && sums[3 * p + 1] > 0.);
      }
    if (n_determined == 0 || grows)
      throw InputError(
        "Fields/" + field.name() + "/Consumption",
        "",
        "a rate > 0 1/day at some cell, or a value or a transfer > 0 at some "
        "boundary point, of each separate piece of the tissue in which "
        "something makes the field",
        "Without a sink a steady field has no level: any constant could be "
        "added to it. Dead cells take nothing.");
    return n_nothing;
  }

  template class FieldSolver<2>;
  template class FieldSolver<3>;
} // namespace Morula
