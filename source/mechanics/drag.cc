// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/drag.h>

namespace Morula
{
  template <int dim>
  Drag<dim>::Drag(const GroupedPoints<dim>  &cells,
                  const std::vector<double> &stiffnesses)
    : moments(cells.offsets.size() - 1)
  {
    for (unsigned int c = 0; c < moments.size(); ++c)
      for (unsigned int p = cells.offsets[c]; p < cells.offsets[c + 1]; ++p)
        moments[c].add(cells.xi[p], {{stiffnesses[p]}});
  }


  template <int dim>
  void
  Drag<dim>::add(const unsigned int     grid_cell,
                 const LocalField<dim> &field,
                 const GrowthAt,
                 LocalSystem<dim> &system) const
  {
    constexpr unsigned int    n      = BSpline<dim>::n;
    constexpr unsigned int    n_dofs = LocalSystem<dim>::n_dofs;
    const std::vector<double> matrix = mass_matrix(moments[grid_cell]);
    double                    energy = 0.;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          {
            const double k = matrix[a * n + b];
            if (system.wanted == LocalSystem<dim>::tangent)
              system.matrix[(i * n + a) * n_dofs + i * n + b] += k;
            else
              {
                const double force = k * field.coefficient[i][b];
                system.add_force(i, a, force);
                energy += 0.5 * field.coefficient[i][a] * force;
              }
          }
    if (system.wanted != LocalSystem<dim>::tangent)
      system.add_energy(energy);
  }


  template class Drag<2>;
  template class Drag<3>;
} // namespace Morula
