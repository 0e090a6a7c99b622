// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/surface_fields.h>

namespace Morula
{
  template <int dim>
  SurfaceFields<dim>::SurfaceFields(const double                time,
                                    const BoundaryColumns<dim> &columns)
    : time(time)
    , declared(columns)
  {
    // The names of the columns, in the order in which add() appends values.
    table.names = {"time",
                   "id",
                   "x",
                   "y",
                   "z",
                   "X",
                   "Y",
                   "Z",
                   "nx",
                   "ny",
                   "nz",
                   "area",
                   "condition"};
    table.whole = {"id", "condition"};
    declared.add_names(table);
    table.n_csv_columns = table.names.size();
    table.csv_only      = {"time", "x", "y", "z"};
    // VTU has vectors, and the displacement, which CSV's readers can compute.
    table.combine("normal", "nx", 3);
    table.add_nonscalar("displacement", 3);
    declared.combine(table);
  }

  template <int dim>
  void
  SurfaceFields<dim>::add(const types::particle_index id,
                          const BoundaryView<dim>    &point,
                          const Point<dim>           &position)
  {
    // This is a n of doc/theory.md (1.2), at present.
    const Tensor<1, dim> area_vector = point.area_vector();
    const double         area        = area_vector.norm();
    const Tensor<1, dim> normal      = area_vector / area;

    std::vector<double> &values = table.values;
    table.ids.push_back(id);
    table.positions.push_back(position);

    values.push_back(time);
    values.push_back(id);
    table.add_vector(position);
    table.add_vector(point.initial_position());
    table.add_vector(normal);
    values.push_back(area);
    values.push_back(static_cast<int>(point.condition()));
    declared.add_values(point.row(), table);
    table.add_vector(position - point.initial_position());
  }

  template class SurfaceFields<2>;
  template class SurfaceFields<3>;
} // namespace Morula
