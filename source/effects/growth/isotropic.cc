// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/catalogue.h>
#include <morula/effects/growth/isotropic.h>
#include <morula/effects/state/present_cell.h>

#include <deal.II/base/symmetric_tensor.h>

namespace Morula
{
  template <int dim>
  IsotropicGrowth<dim>::IsotropicGrowth(
    const IsotropicGrowthParameters &parameters)
    : theta(parameters.stretch.expression(dim))
  {}


  template <int dim>
  IsotropicGrowth<dim>::IsotropicGrowth(
    const IsotropicGrowthParameters &parameters,
    const EffectSetting<dim>        &setting)
    : theta(setting.state.use(parameters.stretch))
  {}


  template <int dim>
  Tensor<2, dim>
  IsotropicGrowth<dim>::growth(const GrowingCell<dim> &cell,
                               const double /*t0*/,
                               const double t1) const
  {
    // This is doc/theory.md (6.1): a function of the end of the step alone, so
    // growth has no error in time.
    const Tensor<2, dim> I(unit_symmetric_tensor<dim>());
    if (!theta.depends_on_state())
      return stretch(cell.founder_position, t1) * I;
    // An estimate before the run has no cells with a state; it counts on no
    // growth.
    return cell.present == nullptr ? I : cell.present->value(theta, t1) * I;
  }


  void
  add_isotropic_growth(Catalogue &catalogue)
  {
    catalogue.add_own<IsotropicGrowth>(
      "isotropic",
      {"Growth/Law=isotropic",
       "Growth/Isotropic/Stretch=1 + 0.1*t*(1 + 0.1*X*Y)"});
  }


  template class IsotropicGrowth<2>;
  template class IsotropicGrowth<3>;
} // namespace Morula
