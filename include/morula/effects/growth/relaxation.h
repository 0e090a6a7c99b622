// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_relaxation_h
#define morula_effects_growth_relaxation_h

#include <morula/effects/effect.h>
#include <morula/mechanics/tissue_material.h>

#include <deal.II/base/tensor.h>

namespace Morula
{
  using namespace dealii;

  /** Tissue that flows under its shear stress, `Material/Relaxation time`:
   *  doc/theory.md, section 8. */
  template <int dim>
  class Relaxation : public Effect<dim>
  {
  public:
    /** @throws InputError for an expression that cannot be parsed */
    Relaxation(const MaterialParameters &parameters, StateColumns<dim> &state);

    /**
     * D of (8.4) in F_g <- D F_g: the flow in (t0, t1], day; the identity if
     * nothing flows.
     * @param cell in its state at @p t0
     * @param F_g  of the other effects at @p t1
     * @throws InputError for a relaxation time or yield stress < 0
     */
    Tensor<2, dim>
    flow(const PresentCell<dim> &cell,
         const Tensor<2, dim>   &F_g,
         const double            t0,
         const double            t1) const;

    void
    check_cell(const PresentCell<dim> &founder,
               const double            step) const override;

    /** Warns of steps that are too long for creep under a load. To be called
     *  only if there is a load. */
    void
    review(const Preview<dim> &scene, Review &review) const override;

  private:
    Expression     time, yield_stress;
    unsigned int   passes;
    TissueMaterial material;
  };
} // namespace Morula

#endif
