// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_isotropic_h
#define morula_effects_growth_isotropic_h

#include <morula/base/expression_key.h>
#include <morula/effects/growth/growth_law.h>

namespace Morula
{
  /** Section "Growth/Isotropic". */
  struct IsotropicGrowthParameters : public EffectKeys
  {
    ExpressionKey stretch{
      {this, "Growth/Isotropic/Stretch"},
      "1",
      "Growth stretch theta(X, Y, Z, t), an expression; > 0. "
      "F_g = theta I; theta = 1 is the initial size.",
      Evaluated::step,
      positive("(a ratio of lengths)", "1 is the initial size.")};
  };

  /**
   * Isotropic growth, F_g = θ(X, t) I, where X is the founder's initial
   * position: doc/theory.md (6.1), equation (13) of the paper.
   */
  template <int dim>
  class IsotropicGrowth : public GrowthLaw<dim>
  {
  public:
    using Parameters = IsotropicGrowthParameters;

    /** @throws InputError for an expression that cannot be parsed */
    explicit IsotropicGrowth(const Parameters &parameters);

    /** The stretch may depend on the cells' state here. @throws InputError */
    IsotropicGrowth(const Parameters         &parameters,
                    const EffectSetting<dim> &setting);

    /**
     * The growth stretch θ at time @p t.
     * @throws InputError if it is not positive
     */
    double
    stretch(const Point<dim> &X, const double t) const
    {
      return theta.value(X, t);
    }

    Tensor<2, dim>
    growth(const GrowingCell<dim> &cell,
           const double            t0,
           const double            t1) const override;

  private:
    Expression theta;
  };
} // namespace Morula

#endif
