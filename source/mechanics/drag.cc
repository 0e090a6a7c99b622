// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/drag.h>

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
  Drag<dim>::add_point(const unsigned int       p,
                       const SplineValues<dim> &splines,
                       const LocalField<dim>   &field,
                       LocalSystem<dim>        &system) const
  {
    const Tensor<1, dim> u = field.value(splines);
    const double         k = stiffnesses[p];
    add_force_at(splines,
                 0.5 * k * u.norm_square(),
                 k * u,
                 k * Tensor<2, dim>(unit_symmetric_tensor<dim>()),
                 system);
  }


  template class Drag<2>;
  template class Drag<3>;
} // namespace Morula
