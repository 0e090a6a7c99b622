// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/particles/cell_domain.h>
#include <morula/simulation/tissue_tables.h>

#include <deal.II/base/mpi.h>

#include <cstdint>
#include <sstream>
#include <vector>

namespace Morula
{
  template <int dim>
  void
  set_state(const TissueModel<dim> &model,
            const Tissue<dim>      &tissue,
            const double            t,
            StatisticsRow          &row)
  {
    // The first pass goes once through this rank's cells and adds up all that
    // is asked of them, as reading a cell with its stress is the costly part.
    // Boundary points only extend the box around the tissue. The second pass
    // makes sums over all ranks of it. The columns of effects are set anew in
    // the order of the scene.
    const auto           &columns = model.tables.columns();
    const Cells<dim>     &cells   = tissue.cells();
    const CellReader<dim> reader  = model.development.reader(t);
    const MPI_Comm        comm    = tissue.communicator();
    TissueSums<dim>       sums;
    LongestCell<dim>      longest(model.scene.grid.spacing);
    std::vector<double>   of_effects(columns.size(), 0.);
    std::uint64_t         held = 0;
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const PresentCell<dim> cell = present_cell(tissue, p, reader);
        sums.add_cell(cell.scalars(), cell.position());
        held += model.development.is_held(cell, t);
        for (std::size_t k = 0; k < columns.size(); ++k)
          // Columns that count events or belong to the step stay 0 here.
          if (columns[k].of_cell)
            of_effects[k] += columns[k].of_cell(cell);
        longest.add(cell.position(), cell_shape<dim>(cell.cell()));
      }
    for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
      sums.add_boundary_point(tissue.boundary_points().position(p));

    row.time    = t;
    row.cells   = Utilities::MPI::sum<std::uint64_t>(cells.size(), comm);
    row.tissue  = sums.totals(comm);
    row.lengths = longest.over_all_ranks(comm);
    row.held_at_checkpoint = Utilities::MPI::sum(held, comm);
    Utilities::MPI::sum(of_effects, comm, of_effects);
    row.of_effects.clear();
    for (std::size_t k = 0; k < columns.size(); ++k)
      row.of_effects.emplace_back(columns[k].name, of_effects[k]);
  }


  template <int dim>
  CellFields<dim>
  cell_table(const TissueModel<dim> &model,
             const Tissue<dim>      &tissue,
             const double            t)
  {
    // The table has this rank's cells in the canonical order (by grid cell,
    // then by id). The output joins those of all ranks.
    const Cells<dim>     &cells = tissue.cells();
    CellFields<dim>       table(t,
                          cells.size(),
                          cells.columns(),
                          model.development.has_checkpoint());
    const CellReader<dim> reader = model.development.reader(t);
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const PresentCell<dim> cell = present_cell(tissue, p, reader);
        // A cell's stress and phase are those of this state and not of the step
        // that led to it.
        table.add(cells.id(p),
                  cells[p],
                  cells.position(p),
                  reader.phase(cells[p]),
                  model.development.is_held(cell, t),
                  cell.quantities());
      }
    return table;
  }


  template <int dim>
  SurfaceFields<dim>
  surface_table(const Tissue<dim> &tissue, const double t)
  {
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    SurfaceFields<dim>         table(t, points.columns());
    for (unsigned int p = 0; p < points.size(); ++p)
      table.add(points.id(p), points[p], points.position(p));
    return table;
  }


  template <int dim>
  std::string
  long_cells_warning(const StatisticsRow &row,
                     const double         grid_spacing,
                     const bool           grows_undivided)
  {
    // The row is that of all ranks. The length is the grid spacing over the
    // least number of cells in it, which is how the column is defined
    // (doc/theory.md, section 2.1).
    const auto        &place = row.lengths.place;
    std::ostringstream text;
    text << "Warning: from t = " << row.time << " day on, fewer than "
         << CellLengths::fewest << " cells fill Grid/Spacing = " << grid_spacing
         << " um where the tissue is stretched: " << row.lengths.n_too_long
         << (row.lengths.n_too_long == 1 ? " cell is" : " cells are")
         << " too long, the longest, at (" << place[0] << ' ' << place[1];
    if (dim == 3)
      text << ' ' << place[2];
    text << ") um, " << grid_spacing / row.lengths.min_cells_per_spacing
         << " um. Do not rely on positions and stresses there, and if it gets "
            "worse the run may fail. Start anew with a smaller Tissue/Cell "
            "spacing or a larger Grid/Spacing"
         << (grows_undivided ? ", or with cells that divide when they have "
                               "grown: Division by size/Volume" :
                               "")
         << "; the column min_cells_per_spacing of statistics.csv has the "
            "number.";
    return text.str();
  }


  std::string
  misfit_warning(const StatisticsRow &row, const double share_at_start)
  {
    std::ostringstream text;
    text << "Warning: from t = " << row.time << " day on, the surface encloses "
         << row.surface->share() << " of the cells' volume, and did "
         << share_at_start
         << " at t = 0: boundary points have left the cells, the surface has a "
            "hole, or cells share space. Loads on the surface and fields that "
            "enter through it are wrong by as much. Tissue/Renew surface makes "
            "it anew; a smaller Grid/Spacing follows the tissue more closely. "
            "The columns enclosed_volume, total_volume and surface_distance of "
            "statistics.csv have the numbers.";
    return text.str();
  }


  MORULA_INSTANTIATE(set_state);
  MORULA_INSTANTIATE(cell_table);
  MORULA_INSTANTIATE(surface_table);
  MORULA_INSTANTIATE(long_cells_warning);
} // namespace Morula
