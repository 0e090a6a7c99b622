// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_rate_growth_h
#define morula_effects_growth_rate_growth_h

#include <morula/base/expression_key.h>
#include <morula/effects/growth/growth_law.h>
#include <morula/effects/state/direction.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <optional>

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

  /** Section "Growth/Rate". */
  struct RateGrowthParameters : public EffectKeys
  {
    RateGrowthParameters();

    ExpressionKey rate{
      {this, "Growth/Rate/Rate"},
      "0",
      "k: rate at which the volume of a cell grows, an expression of its "
      "state; < 0: it withers. Units: 1/day.",
      Evaluated::step};

    /** of the rate; empty: isotropic */
    ExpressionKey share_along{
      {this, "Growth/Rate/Share along"},
      "",
      "s: which share of the rate is growth along Direction, from 0 to 1; the "
      "rest is growth across it. An expression of the cell's state. 0: growth "
      "in a surface, if Direction is its normal; 1: along a fibre; 1/3 (in 2-D "
      "1/2), or empty: isotropic.",
      Evaluated::step};

    Key<bool> predictor{
      {this, "Growth/Rate/Predictor"},
      true,
      "Whether rates that fall as a cell is squeezed foresee the end "
      "of the step, so that confined tissue is stable with steps of "
      "any length. false: the rate at the beginning of the step."};

    ExpressionKey homeostasis{
      {this, "Growth/Rate/Homeostasis"},
      "0",
      "kappa: rate of stress-regulated growth: along each principal "
      "direction a cell grows at kappa times what its stress lies "
      "above Homeostatic stress. Not negative; 0: none. An "
      "expression of the cell's state. Units: 1/(day kPa).",
      Evaluated::step,
      not_negative("1/(day kPa)", "0 is no growth by stress.")};

    ExpressionKey homeostatic_stress{
      {this, "Growth/Rate/Homeostatic stress"},
      "0",
      "sigma*: true stress at which stress-regulated growth comes to rest; < "
      "0: a pressure. An expression of the cell's state. Units: kPa.",
      Evaluated::step};

    CellDirectionKey direction{
      {this, "Growth/Rate/Direction"},
      "",
      "a: direction of Share along in the tissue as it was at t = 0: "
      "'radial', 'surface normal', 'gradient of' a field, or an expression of X, Y, Z with "
      "three components, e.g. 0; 0; 1, of any length but zero. Empty: "
      "growth is isotropic."};
  };

  /**
   * Growth at rates that follow the state of each cell: F_law(t1) = exp(Δt L)
   * F_law(t0) with a rate of the volume, split along and across a direction,
   * and a rate towards a homeostatic stress: doc/theory.md, section 10.
   */
  template <int dim>
  class RateGrowth : public GrowthLaw<dim>
  {
  public:
    using Parameters = RateGrowthParameters;

    /** @throws InputError for expressions that cannot be parsed, or for a share
     *          without direction */
    RateGrowth(const Parameters &parameters, const EffectSetting<dim> &setting);

    Tensor<2, dim>
    growth(const GrowingCell<dim> &cell,
           const double            t0,
           const double            t1) const override;

    /** Whether place and time alone tell growth. */
    bool
    is_known_before() const
    {
      // Only the size has to be known, so a direction that follows the state
      // does no harm.
      return !rate.depends_on_state() && !homeostasis &&
             (!share || !share->depends_on_state());
    }

    void
    remember(const GrowingCell<dim>      &cell,
             const double                 t0,
             const double                 t1,
             const CellView<dim, double> &after) const override;

    GrowthOfStep<dim>
    grow(const GrowingCell<dim>      &cell,
         const double                 t0,
         const double                 t1,
         const CellView<dim, double> &after) const override;

    bool
    follows_state() const override
    {
      return expected.has_value();
    }

    double
    missed(const GrowingCell<dim> &cell) const override
    {
      return size_of(missed_tensor(cell));
    }

    void
    check(const Preview<dim> &scene) const override
    {
      if (is_known_before())
        GrowthLaw<dim>::check(scene);
    }

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

    void
    review(const Preview<dim> &scene, Review &review) const override;

  private:
    /** The rates of a cell at the beginning of a step. */
    struct Rates
    {
      /** k of the volume, and what homeostasis adds to it, tr H. */
      GrowthFeedback of_rate, of_homeostasis;
      /** The deviator of H, 1/day. */
      SymmetricTensor<2, dim> shape;
      /** The fall of `shape`, times Δt, per unit of the shear that grows. */
      double shape_damping = 0.;

      /** Both. */
      GrowthFeedback
      all() const;
    };

    /** What the predictor keeps of the past. */
    struct Memory
    {
      /** ln (J_e det F_law), at time @p time (day). */
      Column<double> place, time;
      /** What the first step withheld; 0 after the second. */
      Column<double> withheld;
    };

    /** L^ of doc/theory.md (5.9): the rate that a step expects at its end. The
     *  rate of the volume is enough where the direction of growth stays. */
    struct Expected
    {
      Column<double>                  volume; // 1/day
      Column<SymmetricTensor<2, dim>> tensor; // 1/day
    };

    Rates
    rates(const PresentCell<dim> &cell, const double t0, const double t1) const;

    /** L of these rates, without forecast, at time @p t (day). */
    SymmetricTensor<2, dim>
    tensor_of(const Rates            &now,
              const PresentCell<dim> &cell,
              const double            t) const
    {
      // This is L of doc/theory.md (10.1): the rate of the volume in its
      // directions, and H as deviator and trace.
      return directed(now.of_rate.rate, &cell, t) + now.shape +
             now.of_homeostasis.rate / dim * unit_symmetric_tensor<dim>();
    }

    /**
     * The growth that the step before missed, doc/theory.md (5.9).
     * @return as a tensor where the direction of growth changes; else what is
     * missing in ln det F_g, as a multiple of the unit tensor
     */
    SymmetricTensor<2, dim>
    missed_tensor(const GrowingCell<dim> &cell) const;

    /** How much @p missed is, as GrowthLaw::missed() says. */
    static double
    size_of(const SymmetricTensor<2, dim> &missed);

    /** Keeps what the step expects of the rates @p now at its end. */
    void
    expect(const GrowingCell<dim>      &cell,
           const Rates                 &now,
           const double                 t0,
           const double                 t1,
           const CellView<dim, double> &after) const;

    /** Keeps what the predictor needs of the past. */
    void
    remember_place(const GrowingCell<dim>      &cell,
                   const Rates                 &now,
                   const double                 t0,
                   const double                 t1,
                   const CellView<dim, double> &after) const;

    /** F_law grown at @p L, if anything is left of the cell. @throws InputError
     */
    Tensor<2, dim>
    grown_at(const SymmetricTensor<2, dim> &L,
             const GrowingCell<dim>        &cell,
             const double                   t0,
             const double                   t1) const;

    /** k_∥ a⊗a + k_⊥ (I − a⊗a) for the rate @p k of the volume. */
    SymmetricTensor<2, dim>
    directed(const double            k,
             const PresentCell<dim> *cell,
             const double            t) const;

    /** The growth that the first step leaves to make up for, and the rate at
     *  which the cell's place widens. */
    FirstStep
    seen_at_first_step(const GrowingCell<dim> &cell, const double t0) const;

    /** L of doc/theory.md (10.1), of a cell that is there. @param now its rates
     *  @param missed as missed_tensor() */
    SymmetricTensor<2, dim>
    rate_of_growth(const GrowingCell<dim>        &cell,
                   Rates                          now,
                   const SymmetricTensor<2, dim> &missed,
                   const double                   t0,
                   const double                   t1) const;

    /** The expression to blame for a cell that grows or withers beyond all
     *  bounds: the one with the largest part in the rate of its volume. */
    const Expression &
    cause_of_size(const GrowingCell<dim> &cell,
                  const double            t0,
                  const double            t1) const;

    Expression                          rate;
    std::optional<Expression>           share;
    std::optional<DirectionOfCell<dim>> direction;
    std::optional<Expression>           homeostasis, homeostatic_stress;
    bool                                predictor;
    bool                                follows_stress;
    double                              slack;
    std::optional<Memory>               memory;
    std::optional<Expected>             expected;
  };
} // namespace Morula

#endif
