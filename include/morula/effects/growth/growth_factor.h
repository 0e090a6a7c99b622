// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_growth_factor_h
#define morula_effects_growth_growth_factor_h

#include <morula/effects/effect.h>

#include <deal.II/base/tensor.h>

namespace Morula
{
  /**
   * A factor of F_g, the deformation that a cell would have free of stress:
   * doc/theory.md (8.7). Factors stand left of the growth law and the cell
   * cycle, in the order of the catalogue from the right. A factor is a function
   * of the cell's state at the beginning of a step; what it must remember is in
   * columns of its own.
   */
  template <int dim>
  class GrowthFactor : public Effect<dim>
  {
  public:
    /**
     * The factor at @p t1, day.
     * @param before the cell at @p t0
     * @param after  its row at t1, with all events of the step
     * @throws InputError where the factor has no value
     */
    virtual Tensor<2, dim>
    factor(const PresentCell<dim>      &before,
           const CellView<dim, double> &after,
           const double                 t0,
           const double                 t1) const = 0;
  };
} // namespace Morula

#endif
