// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_flow_h
#define morula_effects_growth_flow_h

#include <morula/base/past_step.h>
#include <morula/effects/effect.h>

#include <deal.II/base/tensor.h>

#include <optional>

namespace Morula
{
  /** What a flow does to a cell in a step. */
  template <int dim>
  struct FlowOfStep
  {
    /** D of (8.4) in F_g <- D F_g; nothing if nothing flows. */
    std::optional<Tensor<2, dim>> D = {};
    /** An error in the shear of the forecast times this is an error of D. */
    double share = 0.;
    /** Whether the cell begins the step without stress, for the next flows. */
    bool begins_anew = false;
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

    /** Keeps what the next step must know of this one. @param f of the step */
    virtual void
    remember_motion(const CellView<dim, double> &cell,
                    const Tensor<2, dim>        &f) const;

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
