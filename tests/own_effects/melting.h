// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A flow: cells lose all of their shear at once, and keep their volume.

#ifndef own_effects_melting_h
#define own_effects_melting_h

#include <morula/base/expression_key.h>
#include <morula/effects/growth/growth_law.h>
#include <morula/effects/state/present_cell.h>

#include <cmath>

namespace Own
{
  using namespace Morula;

  struct MeltingKeys : public EffectKeys
  {
    ExpressionKey when{{this, "When"}, "", "When cells melt.", Evaluated::step};

    bool
    is_on() const override
    {
      return !when.empty();
    }
  };

  template <int dim>
  class Melting : public Flow<dim>
  {
  public:
    using Parameters = MeltingKeys;

    Melting(const Parameters &parameters, const EffectSetting<dim> &setting)
      : when(setting.state.use(parameters.when))
    {
      setting.columns.need_growth();
    }

    FlowOfStep<dim>
    flow(const PresentCell<dim> &cell,
         const CellView<dim, double> &,
         const Tensor<2, dim> &,
         const Tensor<2, dim> &F_g,
         const double,
         const double t1) const override
    {
      if (!(cell.value(when, t1) > 0.))
        return {};
      const Tensor<2, dim> F_e = cell.cell().F() * invert(F_g);
      return {std::pow(determinant(F_e), -1. / dim) * F_e, 0., true};
    }

  private:
    const Expression when;
  };
} // namespace Own

#endif
