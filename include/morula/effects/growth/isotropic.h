// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_isotropic_h
#define morula_effects_growth_isotropic_h

#include <morula/base/expression.h>
#include <morula/effects/growth/growth_law.h>

#include <deal.II/base/parameter_handler.h>

namespace Morula
{
  using namespace dealii;

  /** Section "Growth/Isotropic". */
  struct IsotropicGrowthParameters
  {
    std::string stretch = "1";

    void
    declare(ParameterHandler &prm);
  };

  /**
   * Isotropic growth, F_g = θ(X, t) I, where X is the founder's initial
   * position: doc/theory.md (6.1), equation (13) of the paper.
   */
  template <int dim>
  class IsotropicGrowth : public GrowthLaw<dim>
  {
  public:
    /** @throws InputError for an expression that cannot be parsed */
    explicit IsotropicGrowth(const IsotropicGrowthParameters &parameters);

    /**
     * The growth stretch θ at time @p t.
     * @throws InputError if it is not positive
     */
    double
    stretch(const Point<dim> &X, const double t) const;

    Tensor<2, dim>
    growth(const GrowingCell<dim> &cell,
           const double            t0,
           const double            t1) const override;

    double
    expected_volume_ratio(const Point<dim> &X, const double t) const override;

  private:
    Expression theta;
  };
} // namespace Morula

#endif
