// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/drag.h>
#include <morula/mechanics/spline_moments.h>

#include <utility>

namespace Morula
{
  template <int dim>
  Drag<dim>::Drag(GroupedPoints<dim> cells, std::vector<double> stiffnesses)
    : PointTerm<dim>(std::move(cells))
    , stiffnesses(std::move(stiffnesses))
  {}


  template <int dim>
  void
  Drag<dim>::set_centre(std::vector<Tensor<1, dim>> ways)
  {
    centre = std::move(ways);
  }


  template <int dim>
  void
  Drag<dim>::set_strength(const double factor)
  {
    strength = factor;
  }


  template <int dim>
  void
  Drag<dim>::add(const unsigned int     grid_cell,
                 const LocalField<dim> &field,
                 const GrowthAt         growth,
                 LocalSystem<dim>      &system) const
  {
    // Energy and residual are sums over the cells, as for any point term.
    if (system.wanted != LocalSystem<dim>::tangent)
      {
        PointTerm<dim>::add(grid_cell, field, growth, system);
        return;
      }
    // The stiffness does not depend on u, so the moments of the cells in the
    // grid cell give the whole matrix: doc/theory.md (11.6). Entries cell by
    // cell would take far longer. All components have the same block.
    const GroupedPoints<dim> &cells = this->points;
    MassMoments<dim>          moments;
    for (unsigned int p = cells.offsets[grid_cell];
         p < cells.offsets[grid_cell + 1];
         ++p)
      moments.add(cells.xi[p], {{strength * stiffnesses[p]}});
    const std::vector<double> mass   = mass_matrix(moments);
    constexpr unsigned int    n      = BSpline<dim>::n;
    constexpr unsigned int    n_dofs = LocalSystem<dim>::n_dofs;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < n; ++a)
        {
          double *const row = &system.matrix[(i * n + a) * n_dofs + i * n];
          for (unsigned int b = 0; b < n; ++b)
            row[b] += mass[a * n + b];
        }
  }


  template <int dim>
  void
  Drag<dim>::add_point(const unsigned int       p,
                       const SplineValues<dim> &splines,
                       const LocalField<dim>   &field,
                       LocalSystem<dim>        &system) const
  {
    Tensor<1, dim> u = field.value(splines);
    if (!centre.empty())
      u -= centre[p];
    const double k = strength * stiffnesses[p];
    system.add_energy(0.5 * k * u.norm_square());
    add_force_at(splines, k * u, system);
  }


  template class Drag<2>;
  template class Drag<3>;
} // namespace Morula
