// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// A growth law with a state of its own: cells take up a dose, and their growth
// stretch rises with it.

#ifndef own_effects_dose_law_h
#define own_effects_dose_law_h

#include <morula/base/expression_key.h>
#include <morula/effects/growth/growth_law.h>

namespace Own
{
  using namespace Morula;

  struct DoseKeys : public EffectKeys
  {
    ExpressionKey uptake{{this, "Uptake"},
                         "0",
                         "Dose taken up, an expression of X, Y, Z. Units: "
                         "1/day.",
                         Evaluated::founder};
    Key<double>   response{{this, "Response"},
                         1.,
                         "Growth stretch for each dose."};
  };

  template <int dim>
  class DoseLaw : public GrowthLaw<dim>
  {
  public:
    using Parameters = DoseKeys;

    DoseLaw(const Parameters &parameters, const EffectSetting<dim> &setting)
      : uptake(parameters.uptake.expression(dim))
      , response(parameters.response)
      , dose(setting.columns.template add<double>(
          {"dose", "", "dose taken up", 0.}))
    {}

    Tensor<2, dim>
    growth(const GrowingCell<dim> &cell,
           const double            t0,
           const double            t1) const override
    {
      const double before = cell.cell != nullptr ? cell.cell->get(dose) : 0.;
      return stretch(before + taken_up(cell.founder_position, t1 - t0)) *
             Tensor<2, dim>(unit_symmetric_tensor<dim>());
    }

    void
    advance(const PresentCell<dim>      &before,
            const CellView<dim, double> &after,
            const double                 t0,
            const double                 t1) const override
    {
      after.set(dose,
                before.cell().get(dose) +
                  taken_up(before.cell().founder_position(), t1 - t0));
    }

  private:
    double
    taken_up(const Point<dim> &X, const double time) const
    {
      return uptake.value(X, 0.) * time;
    }

    double
    stretch(const double dose_taken) const
    {
      return 1. + response * dose_taken;
    }

    const Expression     uptake;
    const double         response;
    const Column<double> dose;
  };
} // namespace Own

#endif
