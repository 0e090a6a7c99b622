// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_cell_shape_axis_h
#define morula_effects_division_cell_shape_axis_h

#include <morula/effects/division/axis_rules.h>

namespace Morula
{
  /**
   * `Division axis = cell shape`: along the longest axis of the cell, Hertwig's
   * rule, doc/theory.md (6.10b). A cell's shape is the one that its founder's
   * cube has got by the tissue's deformation, halved at each division across
   * the axis.
   */
  template <int dim>
  class CellShapeAxis : public PresentAxis<dim>
  {
  public:
    /** Asks for the shape of cells. */
    CellShapeAxis(const NoAxisKeys &, const EffectSetting<dim> &setting);

    Tensor<1, dim>
    axis(const CellAtOnset<dim> &cell) const override;
  };
} // namespace Morula

#endif
