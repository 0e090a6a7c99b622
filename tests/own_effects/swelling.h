// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A growth factor: cells swell by the same in all directions.

#ifndef own_effects_swelling_h
#define own_effects_swelling_h

#include <morula/base/expression_key.h>
#include <morula/effects/growth/growth_law.h>
#include <morula/effects/state/present_cell.h>

namespace Own
{
  using namespace Morula;

  struct SwellingKeys : public EffectKeys
  {
    ExpressionKey stretch{{this, "Stretch"},
                          "1",
                          "Length of a cell over that without swelling; > 0.",
                          Evaluated::step};

    bool
    is_on() const override
    {
      return !stretch.is_default();
    }
  };

  template <int dim>
  class Swelling : public GrowthFactor<dim>
  {
  public:
    using Parameters = SwellingKeys;

    Swelling(const Parameters &parameters, const EffectSetting<dim> &setting)
      : stretch(setting.state.use(parameters.stretch))
    {
      setting.columns.need_growth();
    }

    Tensor<2, dim>
    factor(const PresentCell<dim> &before,
           const CellView<dim, double> &,
           const double,
           const double t1) const override
    {
      return before.value(stretch, t1) *
             Tensor<2, dim>(unit_symmetric_tensor<dim>());
    }

  private:
    const Expression stretch;
  };
} // namespace Own

#endif
