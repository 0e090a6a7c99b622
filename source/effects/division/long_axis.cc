// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/division/directions.h>
#include <morula/effects/division/long_axis.h>
#include <morula/effects/state/present_cell.h>

#include <cmath>

namespace Morula
{
  template <int dim>
  LongAxis<dim>::LongAxis(const NoAxisKeys &, const EffectSetting<dim> &setting)
    : shape(setting.columns.template add<Tensor<2, dim>>(
        {"shape",
         "",
         "H: F H is what divisions have left of a founder's cube",
         Tensor<2, dim>(unit_symmetric_tensor<dim>())}))
  {}


  template <int dim>
  Tensor<1, dim>
  LongAxis<dim>::axis(const CellAtOnset<dim> &cell) const
  {
    // Before there are cells, and for cells that are about as long in all
    // directions, the random axis stands in.
    if (cell.present == nullptr)
      return cell.random;
    const CellView<dim, const double> &view = cell.present->cell();
    return Directions::of_largest_stretch(view.F() * view.get(shape),
                                          cell.least_anisotropy,
                                          cell.random)
      .value_or(cell.random);
  }


  template <int dim>
  void
  LongAxis<dim>::divided(const CellView<dim, double> &daughter,
                         const Tensor<1, dim>        &axis) const
  {
    // This is doc/theory.md (6.10b). Only the ratios of lengths matter, so the
    // determinant is kept at 1.
    const Tensor<2, dim> F      = daughter.F();
    const Tensor<2, dim> FH     = F * daughter.get(shape);
    const Tensor<2, dim> halved = FH - 0.5 * outer_product(axis, axis * FH);
    daughter.set(shape, std::pow(2., 1. / dim) * (invert(F) * halved));
  }


  template class LongAxis<2>;
  template class LongAxis<3>;
} // namespace Morula
