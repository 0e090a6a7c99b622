// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_forgetting_h
#define morula_effects_growth_forgetting_h

#include <morula/effects/growth/flow.h>
#include <morula/effects/state/present_cell.h>

namespace Morula
{
  /** Cells that change their type and are then free of stress as they stand,
   *  `Material/On transition`: doc/theory.md, section 6.8. All that is elastic
   *  in F flows at once. */
  template <int dim>
  class Forgetting : public Flow<dim>
  {
  public:
    FlowOfStep<dim>
    flow(const PresentCell<dim>      &cell,
         const CellView<dim, double> &after,
         const Tensor<2, dim> &,
         const Tensor<2, dim> &,
         const double,
         const double) const override
    {
      if (after.get(cell.reader().columns.type) == cell.type())
        return {};
      // All of F_e becomes growth, so that none of it is left with the growth
      // of t0.
      return {cell.elastic(), 0., true};
    }
  };
} // namespace Morula

#endif
