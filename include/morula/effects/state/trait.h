// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_state_trait_h
#define morula_effects_state_trait_h

#include <morula/effects/effect.h>
#include <morula/effects/state/present_cell.h>

namespace Morula
{
  /**
   * What a cell has besides its growth and its fates: a state in columns of its
   * own, which other effects may read by the columns' names. The columns
   * declare what a daughter inherits.
   */
  template <int dim>
  class Trait : public Effect<dim>
  {
  public:
    void
    advance(const PresentCell<dim>      &before,
            const CellView<dim, double> &after,
            const double                 t0,
            const double                 t1) const override = 0;
  };
} // namespace Morula

#endif
