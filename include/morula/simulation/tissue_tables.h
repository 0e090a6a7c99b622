// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_tissue_tables_h
#define morula_simulation_tissue_tables_h

#include <morula/output/cell_fields.h>
#include <morula/output/rows.h>
#include <morula/output/surface_fields.h>
#include <morula/scene/tissue_model.h>

namespace Morula
{
  /** Sets the columns of @p row about the tissue at @p t (day); those of the
   *  effects that count events or belong to the step are 0 then. Other columns
   *  about the step stay. Collective. */
  template <int dim>
  void
  set_state(const TissueModel<dim> &model,
            const Tissue<dim>      &tissue,
            const double            t,
            StatisticsRow          &row);

  /** The table behind cells-NNNN.csv and .vtu, at @p t, day. */
  template <int dim>
  CellFields<dim>
  cell_table(const TissueModel<dim> &model,
             const Tissue<dim>      &tissue,
             const double            t);

  /** The table behind surface-NNNN.csv and .vtu, at @p t, day. */
  template <int dim>
  SurfaceFields<dim>
  surface_table(const Tissue<dim> &tissue, const double t);

  /** The warning about cells that are too long for the grid. */
  template <int dim>
  std::string
  long_cells_warning(const StatisticsRow &row,
                     const double         grid_spacing,
                     const bool           grows_undivided);

  /** The warning about a surface that does not enclose its cells any more.
   *  @param share_at_start as RunState::enclosed_share */
  std::string
  misfit_warning(const StatisticsRow &row, const double share_at_start);
} // namespace Morula

#endif
