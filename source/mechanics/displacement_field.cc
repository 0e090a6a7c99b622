// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/condensation.h>
#include <morula/mechanics/displacement_field.h>

#include <vector>

namespace Morula
{
  template <int dim>
  DisplacementField<dim>::DisplacementField(
    const SplineSpace<dim>              &space,
    const TrilinosWrappers::MPI::Vector &u,
    const MPI_Comm                       comm)
    : space(space)
    , relevant(space.owned_dofs(), space.relevant_dofs(), comm)
  {
    relevant = u;
  }

  template <int dim>
  LocalField<dim>
  DisplacementField<dim>::on_grid_cell(const unsigned int grid_cell) const
  {
    // A ghosted Trilinos vector stores its entries in the order of the set of
    // relevant degrees of freedom.
    const double *const values   = relevant.trilinos_vector()[0];
    const auto         &unknowns = space.grid_cells()[grid_cell].unknowns;
    std::vector<double> coefficients(dim * unknowns.size());
    for (unsigned int s = 0; s < unknowns.size(); ++s)
      for (unsigned int i = 0; i < dim; ++i)
        coefficients[i * unknowns.size() + s] = values[unknowns[s] * dim + i];
    return Condensation<dim>(space.grid_cells()[grid_cell])
      .expand(coefficients);
  }

  template class DisplacementField<2>;
  template class DisplacementField<3>;
} // namespace Morula
