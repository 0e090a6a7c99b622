// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_growth_rates_h
#define morula_effects_growth_growth_rates_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

namespace Morula
{
  using namespace dealii;

  /** k_∥ a⊗a + k_⊥ (I − a⊗a): doc/theory.md (10.2). @param a of length 1 */
  template <int dim>
  SymmetricTensor<2, dim>
  rate_along_and_across(const Tensor<1, dim> &a,
                        const double          along,
                        const double          across);

  /**
   * exp(Δt L) @p before: F_law after growth at the rate @p L (1/day) for @p dt
   * (day), doc/theory.md (10.1). Exact if L is constant.
   */
  template <int dim>
  Tensor<2, dim>
  grown(const Tensor<2, dim>          &before,
        const SymmetricTensor<2, dim> &L,
        const double                   dt);

  /** A rate of growth, and how it falls with growth during one step. */
  struct GrowthFeedback
  {
    /** k, at the beginning of the step, 1/day. */
    double rate = 0.;
    /** c >= 0: by how much k falls, times Δt, per unit of ln det F_g at the
     *  same F. */
    double damping = 0.;
  };

  /** (1 - e^-c) / c: the mean over a step of what decays by e^-c in it,
   *  doc/theory.md (10.5). @param c >= 0 */
  double
  mean_of_decay(const double c);

  /**
   * The predictor for one of the rates k and h whose sum is the growth of a
   * cell, doc/theory.md (10.5): the mean rate of @p part over the step, 1/day,
   * if the cell's place widens steadily at the rate @p widening (1/day).
   * @param all k + h, with the sum of their c
   */
  double
  predicted_rate(const GrowthFeedback &part,
                 const GrowthFeedback &all,
                 const double          widening);

  /** The rate of @p part at the end of a step for which it was predicted, as
   *  far as its own feedback tells, 1/day: doc/theory.md (10.5a). */
  double
  expected_rate(const GrowthFeedback &part,
                const GrowthFeedback &all,
                const double          widening);

  /** The growth to make up for after the first step, when it is known how far
   *  the tissue gave way, doc/theory.md (10.6). */
  struct FirstStep
  {
    /** Growth to make up for, in ln det F_g. */
    double due = 0.;
    /** The rate at which the cell's place would have widened, 1/day. */
    double widening = 0.;
  };

  /**
   * @param grown    by which ln det F_g has grown in the first step
   * @param withheld by which it would have grown besides without predictor
   * @param squeezed −ln J_e, which was 0 before
   * @param dt       length of that step, day
   */
  FirstStep
  after_first_step(const double grown,
                   const double withheld,
                   const double squeezed,
                   const double dt);
} // namespace Morula

#endif
