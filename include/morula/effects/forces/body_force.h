// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_forces_body_force_h
#define morula_effects_forces_body_force_h

#include <morula/base/expression_key.h>
#include <morula/effects/forces/force.h>

namespace Morula
{
  /** Section "Body force". */
  struct BodyForceParameters : public EffectKeys
  {
    ExpressionKey force_density{
      {this, "Body force/Force density"},
      "0; 0; 0",
      "Force per initial volume: an expression for each "
      "direction, separated by ';'. Units: kPa/um.",
      Evaluated::step,
      3};

    bool
    is_on() const override
    {
      return force_density.is_changed();
    }
    std::string
    details() const override
    {
      return force_density.text() + " kPa/um";
    }
  };

  /** A force per initial volume: doc/theory.md (4.7), equation (4) of the
   *  paper. It may depend on the state of cells at the beginning of a step, and
   * on their place at its end. */
  template <int dim>
  class BodyForce : public Force<dim>
  {
  public:
    using Parameters = BodyForceParameters;

    /** @throws InputError for an expression that cannot be parsed */
    BodyForce(const Parameters &parameters, const EffectSetting<dim> &setting);

    std::unique_ptr<Term<dim>>
    term(const Tissue<dim>        &tissue,
         const CellReader<dim>    &reader,
         const GroupedPoints<dim> &positions,
         const double              t0,
         const double              t1) const override;

    std::optional<Tensor<1, dim>>
    load_of(const PresentCell<dim> &cell, const double t) const override
    {
      return cell.vector(density, t);
    }

    void
    check(const Preview<dim> &scene) const override;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

    void
    review(const Preview<dim> &scene, Review &review) const override;

  private:
    const Expression density;
  };
} // namespace Morula

#endif
