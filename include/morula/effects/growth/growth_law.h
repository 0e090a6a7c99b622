// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_growth_law_h
#define morula_effects_growth_growth_law_h

#include <morula/base/past_step.h>
#include <morula/effects/effect.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <optional>

namespace Morula
{
  using namespace dealii;

  /** What a growth law sees of a cell at the beginning t0 of a step. */
  template <int dim>
  struct GrowingCell
  {
    /** X of the founder, µm. */
    Point<dim> founder_position;
    /** The law's part of F_g at t0, without the cell cycle. */
    Tensor<2, dim> growth;
    /** F_e, equation (1.3). */
    Tensor<2, dim> elastic;
    /** The cell with all its columns; null before there are cells. */
    const CellView<dim, const double> *cell = nullptr;
    /** The state of the cell, for expressions; null before there are cells. */
    const PresentCell<dim> *present = nullptr;
  };

  /** What a law makes of a cell in a step. */
  template <int dim>
  struct GrowthOfStep
  {
    /** The law's part of F_g at the end. */
    Tensor<2, dim> growth;
    /** |missed| of the step before: GrowthLaw::missed(). */
    double missed = 0.;
  };

  /**
   * A law of growth without division: `Growth/Law`. With a cell cycle as well,
   * F_g is the product of the law's part and the cycle's, (6.1) and (6.2).
   *
   * A law keeps nothing between calls. All that it may depend on is a cell's
   * state at the beginning of a step, which is saved with the cell.
   */
  template <int dim>
  class GrowthLaw : public Effect<dim>
  {
  public:
    /**
     * The law's part of F_g at @p t1, from the state at @p t0 (day). Called
     * again with a smaller @p t1 if a step is halved. The part is the identity
     * at t = 0.
     * @throws InputError where the law has no value
     */
    virtual Tensor<2, dim>
    growth(const GrowingCell<dim> &cell,
           const double            t0,
           const double            t1) const = 0;

    /**
     * Writes the law's own columns at the end of the step for which growth()
     * was called.
     * `after` is the cell at @p t1.
     */
    virtual void
    remember(const GrowingCell<dim> & /*cell*/,
             const double /*t0*/,
             const double /*t1*/,
             const CellView<dim, double> & /*after*/) const
    {}

    /** growth() and remember() in one, and what the step before missed: a law
     *  may have less to do for both. */
    virtual GrowthOfStep<dim>
    grow(const GrowingCell<dim>      &cell,
         const double                 t0,
         const double                 t1,
         const CellView<dim, double> &after) const
    {
      // By default a law misses nothing: its growth does not follow the state.
      // A law for which growth() and remember() compute the same overrides
      // this.
      const Tensor<2, dim> F = growth(cell, t0, t1);
      remember(cell, t0, t1, after);
      return {F};
    }

    /** Whether growth follows the state of cells, so that a step can miss some
     *  of it. */
    virtual bool
    follows_state() const
    {
      return false;
    }

    /** |missed| of doc/theory.md (5.9), in ln det F_g: what the step that led
     *  to this state missed of the cell's growth. */
    virtual double
    missed(const GrowingCell<dim> &) const
    {
      return 0.;
    }

    /** Evaluates the law as the first and the last step will. */
    void
    check(const Preview<dim> &scene) const override;

    /** Warns of steps in which cells grow too much. */
    void
    review(const Preview<dim> &scene, Review &review) const override;
  };

  /**
   * A factor of F_g, the deformation that a cell would have free of stress:
   * doc/theory.md (8.7). Factors stand left of the growth law and the cell
   * cycle, in the order of the catalogue from the right. A factor is a function
   * of the cell's state at the beginning of a step; what it must remember is in
   * columns of its own.
   */
  template <int dim>
  class GrowthFactor : public Effect<dim>
  {
  public:
    /**
     * The factor at @p t1, day.
     * @param before the cell at @p t0
     * @param after  its row at t1, with all events of the step
     * @throws InputError where the factor has no value
     */
    virtual Tensor<2, dim>
    factor(const PresentCell<dim>      &before,
           const CellView<dim, double> &after,
           const double                 t0,
           const double                 t1) const = 0;
  };

  /** What a flow does to a cell in a step. */
  template <int dim>
  struct FlowOfStep
  {
    /** D of (8.4) in F_g <- D F_g; nothing if nothing flows. */
    std::optional<Tensor<2, dim>> D = {};
    /** An error in the shear of the forecast times this is an error of D. */
    double share = 0.;
    /** Whether the cell begins the step with D already, for the next flows. */
    bool at_once = false;
    /** Δt/τ; 0 if stress does not fade with time. */
    double exponent = 0.;
    /** What is left of a stress that fades: e^(-Δt/τ), or 1 below a yield
     *  stress. */
    double kept = 1.;
  };

  /** How far a cell relaxes in a step. */
  struct Relaxed
  {
    /** The sum of FlowOfStep::exponent, and the product of FlowOfStep::kept. */
    double exponent = 0., kept = 1.;
  };

  /**
   * Flow of a cell, which takes stress from its elastic part: relaxation,
   * plasticity. F_g of all other effects at the end of the step is multiplied
   * by D from the left, flow by flow in the order of the catalogue:
   * doc/theory.md (8.4). What has flowed is kept with the cell.
   */
  template <int dim>
  class Flow : public Effect<dim>
  {
  public:
    /**
     * The flow in (t0, t1], day.
     * @param cell   in its state at @p t0
     * @param after  its row at t1, with all events of the step
     * @param before F_g at @p t0
     * @param F_g    of the other effects at @p t1
     * @throws InputError where it has no value
     */
    virtual FlowOfStep<dim>
    flow(const PresentCell<dim>      &cell,
         const CellView<dim, double> &after,
         const Tensor<2, dim>        &before,
         const Tensor<2, dim>        &F_g,
         const double                 t0,
         const double                 t1) const = 0;

    /** Keeps what the next step must know of this one, whose f is given. */
    virtual void
    remember_motion(const CellView<dim, double> & /*cell*/,
                    const Tensor<2, dim> & /*f*/) const
    {}

    /** Whether the flow of a step is found from a forecast of its motion, so
     *  that the step's error is known. */
    virtual bool
    has_forecast() const
    {
      return false;
    }

    /** |dev(U − U*)| of a step of length @p dt (day) with the deformation @p f,
     *  of which U* was the forecast from the step @p past; 0 for a flow that
     *  needs none. */
    virtual double
    error_of_forecast(const CellView<dim, const double> &,
                      const Tensor<2, dim> &,
                      const PastStep &,
                      const double) const
    {
      return 0.;
    }
  };
} // namespace Morula

#endif
