// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/division/cell_shape_axis.h>
#include <morula/effects/division/directions.h>
#include <morula/effects/state/present_cell.h>

namespace Morula
{
  template <int dim>
  CellShapeAxis<dim>::CellShapeAxis(const NoAxisKeys &,
                                    const EffectSetting<dim> &setting)
  {
    setting.columns.need_shape();
  }


  template <int dim>
  Tensor<1, dim>
  CellShapeAxis<dim>::axis(const CellAtOnset<dim> &cell) const
  {
    // Before there are cells, and for cells that are about as long in all
    // directions, the random axis stands in.
    if (cell.present == nullptr)
      return cell.random;
    return Directions::of_largest_stretch(cell.present->cell().shape(),
                                          cell.least_anisotropy,
                                          cell.random)
      .value_or(cell.random);
  }


  template class CellShapeAxis<2>;
  template class CellShapeAxis<3>;
} // namespace Morula
