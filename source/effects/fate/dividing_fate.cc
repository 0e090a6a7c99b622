// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/division/halve_shape.h>
#include <morula/effects/fate/dividing_fate.h>

namespace Morula
{
  template <int dim>
  const DivisionRule<dim> *
  DividingFate<dim>::rule(const unsigned int type) const
  {
    return axes ? axes->rules().rule(type) : nullptr;
  }


  template <int dim>
  void
  DividingFate<dim>::check(const Preview<dim> &scene) const
  {
    if (axes)
      for (const auto &rule : axes->rules().list)
        rule->check(scene);
  }


  template <int dim>
  void
  DividingFate<dim>::review(const Preview<dim> &scene, Review &review) const
  {
    if (axes)
      for (const auto &rule : axes->rules().list)
        rule->review(scene, review);
  }


  template <int dim>
  void
  DividingFate<dim>::halve(const CellView<dim, double> &daughter,
                           const StateColumns<dim>     &columns) const
  {
    halve_shape(daughter,
                this->placement_axis(daughter,
                                     columns.type.exists() ?
                                       daughter.get(columns.type) :
                                       0));
  }


  template class DividingFate<2>;
  template class DividingFate<3>;
} // namespace Morula
