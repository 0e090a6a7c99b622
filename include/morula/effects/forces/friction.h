// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_forces_friction_h
#define morula_effects_forces_friction_h

#include <morula/base/expression_key.h>
#include <morula/effects/forces/force.h>

#include <vector>

namespace Morula
{
  /** Section "Friction". */
  struct FrictionParameters : public EffectKeys
  {
    ExpressionKey coefficient{
      {this, "Friction/Coefficient"},
      "0",
      "Friction of cells, also inside of the tissue, with "
      "surroundings that stand still: the force on a cell per "
      "initial volume is minus this times its velocity; >= 0. An "
      "expression. Units: kPa day/um^2.",
      Evaluated::step,
      not_negative("kPa day/um^2", "0 is no friction.")};

    bool
    is_on() const override;
    std::string
    details() const override
    {
      return coefficient.text() + " kPa day/um^2";
    }
  };

  /** Friction of cells with surroundings that stand still: doc/theory.md
   * (4.7a). Its coefficient is that of the cell's state at the beginning of a
   * step. */
  template <int dim>
  class Friction : public Force<dim>
  {
  public:
    using Parameters = FrictionParameters;

    /** @throws InputError for an expression that cannot be parsed */
    Friction(const Parameters &parameters, const EffectSetting<dim> &setting);

    std::unique_ptr<Term<dim>>
    term(const Tissue<dim>        &tissue,
         const CellReader<dim>    &reader,
         const GroupedPoints<dim> &positions,
         const double              t0,
         const double              t1) const override;

    std::vector<double>
    friction(const Tissue<dim>     &tissue,
             const CellReader<dim> &reader,
             const double           t0) const override;

    std::optional<double>
    friction_of(const PresentCell<dim> &cell, const double t0) const override
    {
      return cell.value(coefficient, t0);
    }

    void
    check(const Preview<dim> &scene) const override;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

  private:
    const Expression coefficient;
  };
} // namespace Morula

#endif
