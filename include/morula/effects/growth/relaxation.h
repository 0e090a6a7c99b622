// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_relaxation_h
#define morula_effects_growth_relaxation_h

#include <morula/base/past_step.h>
#include <morula/effects/effect.h>
#include <morula/mechanics/tissue_material.h>

#include <deal.II/base/tensor.h>

namespace Morula
{
  using namespace dealii;

  /**
   * Tissue that flows under its shear stress, `Material/Relaxation time`:
   * doc/theory.md, section 8. A step's flow sees where the tissue goes if it
   * moves as in the step before; so each cell keeps the stretch of that one.
   */
  template <int dim>
  class Relaxation : public Effect<dim>
  {
  public:
    /** @throws InputError for an expression that cannot be parsed */
    Relaxation(const MaterialParameters &parameters,
               StateColumns<dim>        &state,
               CellColumns<dim>         &columns);

    /** What a step's flow is. */
    struct FlowOfStep
    {
      /** D of (8.4) in F_g <- D F_g; the identity if nothing flows. */
      Tensor<2, dim> D;
      /** Which part of an error in the shear of the forecast is one of D. */
      double share;
    };

    /**
     * The flow in (t0, t1], day, of the shear that doc/theory.md (8.3a) gives.
     * @param cell   in its state at @p t0
     * @param before F_g at @p t0
     * @param F_g    of the other effects at @p t1
     * @throws InputError for a relaxation time or yield stress < 0
     */
    FlowOfStep
    flow(const PresentCell<dim> &cell,
         const Tensor<2, dim>   &before,
         const Tensor<2, dim>   &F_g,
         const double            t0,
         const double            t1) const;

    /** Keeps the stretch of a step. @param f of the step */
    void
    remember_motion(const CellView<dim, double> &cell,
                    const Tensor<2, dim>        &f) const;

    /** |dev(U − U*)| of a step of length @p dt (day) with the deformation @p f,
     *  of which U* was the forecast from the step @p past. */
    double
    error_of_forecast(const CellView<dim, const double> &cell,
                      const Tensor<2, dim>              &f,
                      const PastStep                    &past,
                      const double                       dt) const;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

    /** Warns of steps that are too long for creep under a load. To be called
     *  only if there is a load. */
    void
    review(const Preview<dim> &scene, Review &review) const override;

  private:
    /** U* of doc/theory.md (8.3b): the stretch of a step of length @p dt (day)
     *  if the tissue goes on as in the step @p past. */
    SymmetricTensor<2, dim>
    forecast(const CellView<dim, const double> &cell,
             const PastStep                    &past,
             const double                       dt) const;

    Expression                      time, yield_stress;
    unsigned int                    passes;
    TissueMaterial                  material;
    Column<SymmetricTensor<2, dim>> motion; // fᵀf
  };
} // namespace Morula

#endif
