// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/condensation.h>
#include <morula/mechanics/spline_field.h>

namespace Morula
{
  template <int dim, int n_components>
  SplineField<dim, n_components>::SplineField(
    const SplineSpace<dim>                 &space,
    const FieldUnknowns<dim, n_components> &unknowns,
    const TrilinosWrappers::MPI::Vector    &u)
    : space(space)
    , values(unknowns.fetch(u))
  {}

  template <int dim, int n_components>
  SplineField<dim, n_components>::SplineField(
    const SplineSpace<dim>              &space,
    const TrilinosWrappers::MPI::Vector &u,
    const MPI_Comm                       comm)
    : SplineField(space, FieldUnknowns<dim, n_components>(space, comm), u)
  {}

  template <int dim, int n_components>
  LocalField<dim, n_components>
  SplineField<dim, n_components>::on_grid_cell(
    const unsigned int grid_cell) const
  {
    const auto &unknowns = space.grid_cells()[grid_cell].unknowns;
    if (space.grid_cells()[grid_cell].weights.empty())
      {
        // Inside of the tissue the unknowns are the splines, and their values
        // are copied.
        LocalField<dim, n_components> field;
        for (unsigned int s = 0; s < unknowns.size(); ++s)
          for (unsigned int i = 0; i < n_components; ++i)
            field.coefficient[i][s] = values[unknowns[s] * n_components + i];
        return field;
      }
    // At the surface the outer splines follow from the unknowns by C,
    // doc/theory.md (3.5), which wants the values component after component.
    std::vector<double> coefficients(n_components * unknowns.size());
    for (unsigned int s = 0; s < unknowns.size(); ++s)
      for (unsigned int i = 0; i < n_components; ++i)
        coefficients[i * unknowns.size() + s] =
          values[unknowns[s] * n_components + i];
    return Condensation<dim, n_components>(space.grid_cells()[grid_cell])
      .expand(coefficients);
  }

  template class SplineField<2, 1>;
  template class SplineField<2, 2>;
  template class SplineField<2, 3>;
  template class SplineField<3, 1>;
  template class SplineField<3, 2>;
  template class SplineField<3, 3>;
} // namespace Morula
