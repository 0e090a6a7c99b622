// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/division/division_rule.h>
#include <morula/effects/state/present_cell.h>

#include <deal.II/base/symmetric_tensor.h>

namespace Morula
{
  template <int dim>
  void
  DivisionRule<dim>::check(const Preview<dim> &scene) const
  {
    // There are no cells yet. A direction stands for the random one, and the
    // undeformed state for theirs; only an error of the rule matters, and the
    // axis is dropped.
    Tensor<1, dim> direction;
    direction[0] = 1.;
    for (const Point<dim> &X : scene.founders)
      axis({X, Tensor<2, dim>(unit_symmetric_tensor<dim>()), direction});
  }


  template <int dim>
  void
  DivisionRule<dim>::check_cell(const PresentCell<dim> &founder,
                                const double) const
  {
    Tensor<1, dim> direction;
    direction[0] = 1.;
    axis({founder.cell().founder_position(),
          founder.elastic(),
          direction,
          &founder});
  }


  template class DivisionRule<2>;
  template class DivisionRule<3>;
} // namespace Morula
