// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/cell_fields.h>

namespace Morula
{
  template <int dim>
  CellFields<dim>::CellFields(const double            time,
                              const std::size_t       n_cells,
                              const CellColumns<dim> &columns,
                              const bool              has_checkpoint)
    : time(time)
    , has_checkpoint(has_checkpoint)
    , declared(columns)
  {
    // The names of the columns in the order in which add() appends values:
    // those of every cell, the checkpoint's, those that effects declare. What
    // stands behind n_csv_columns is for VTU alone, as it follows from the
    // others. Vectors and tensors are names for several columns there.
    table.names = {"time",
                   "id",
                   "parent",
                   "generation",
                   "phase",
                   "x",
                   "y",
                   "z",
                   "X",
                   "Y",
                   "Z",
                   "initial_volume",
                   "volume",
                   "growth_volume_ratio",
                   "elastic_volume_ratio",
                   "energy_density",
                   "sigma_xx",
                   "sigma_yy",
                   "sigma_zz",
                   "sigma_xy",
                   "sigma_yz",
                   "sigma_zx"};
    if (has_checkpoint)
      table.names.push_back("held_at_checkpoint");
    // Names that do not exist in a table do not matter here.
    table.whole = {"id", "parent", "generation", "phase", "held_at_checkpoint"};
    declared.add_names(table);
    table.n_csv_columns = table.names.size();
    table.csv_only      = {"time", "x", "y", "z"};

    for (const char *name : {"pressure",
                             "principal_stress_1",
                             "principal_stress_2",
                             "principal_stress_3"})
      table.names.push_back(name);
    table.add_nonscalar("displacement", 3);
    table.combine("sigma", "sigma_xx", 6);
    declared.combine(table);
    table.reserve(n_cells);
  }

  template <int dim>
  void
  CellFields<dim>::add(const types::particle_index        id,
                       const CellView<dim, const double> &cell,
                       const Point<dim>                  &position,
                       const unsigned int                 phase,
                       const bool                         held,
                       const CellQuantities              &q)
  {
    // The values in the order of the names, and all of them: the table is one
    // long list, row by row.
    const SymmetricTensor<2, 3> &sigma  = q.stress;
    std::vector<double>         &values = table.values;
    table.ids.push_back(id);
    table.positions.push_back(position);

    for (const double value : {time,
                               static_cast<double>(id),
                               static_cast<double>(cell.parent()),
                               static_cast<double>(cell.generation()),
                               static_cast<double>(phase)})
      values.push_back(value);
    table.add_vector(position);
    table.add_vector(cell.founder_position());
    for (const double value : {q.initial_volume,
                               q.volume,
                               q.growth_volume_ratio,
                               q.elastic_volume_ratio,
                               q.energy_density,
                               sigma[0][0],
                               sigma[1][1],
                               sigma[2][2],
                               sigma[0][1],
                               sigma[1][2],
                               sigma[2][0]})
      values.push_back(value);
    if (has_checkpoint)
      values.push_back(held);
    declared.add_values(cell.row(), table);
    // The values for VTU alone: pressure, principal stresses, displacement.
    values.push_back(-trace(sigma) / 3.);
    for (const double principal : eigenvalues(sigma))
      values.push_back(principal);
    table.add_vector(position - cell.founder_position());
  }

  template class CellFields<2>;
  template class CellFields<3>;
} // namespace Morula
