// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_relaxation_h
#define morula_mechanics_relaxation_h

#include <morula/mechanics/material.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

namespace Morula
{
  using namespace dealii;

  /** How the shear of a piece of tissue relaxes, at one moment. */
  struct FlowLaw
  {
    /** τ_r, day; > 0. In it the shear stress of held tissue falls to 1/e. */
    double relaxation_time;
    /** The von Mises stress of τ up to which nothing flows, kPa; 0: none. */
    double yield_stress = 0.;
    /** Number of equal parts into which a step with a yield stress is cut. */
    unsigned int passes = 1;
  };

  /** The von Mises stress √(3/2) |dev τ| of the Kirchhoff stress, kPa. In 2-D
   *  dev is the deviator in the plane: doc/theory.md (8.6). */
  template <int dim>
  double
  von_mises_stress(const Tensor<2, dim> &F_e,
                   const Lame           &lame,
                   const Material       &material);

  /** w = 1/(1 − e^{−γ}) − 1/γ: which part of the strain that a step brings
   *  the flow must see, doc/theory.md (8.3a). @param gamma Δt/τ_r >= 0 */
  double
  weight_of_end(const double gamma);

  /**
   * The flow of tissue whose shape is held for @p dt (day): exact,
   * doc/theory.md (8.2a), (8.3), (8.4); with a yield stress by backward Euler,
   * (8.5). Stable for any @p dt; for @p dt → ∞ the complete relaxation of what
   * is above the yield stress.
   *
   * @param F_e elastic part of the deformation gradient, det F_e > 0
   * @return D, symmetric and positive definite with det D = 1: F_e becomes F_e
   *         D⁻¹, and F stays if the factor to the right of F_e is multiplied by
   *         D from the left
   */
  template <int dim>
  SymmetricTensor<2, dim>
  flow_of_step(const Tensor<2, dim> &F_e,
               const Lame           &lame,
               const Material       &material,
               const FlowLaw        &flow,
               const double          dt);

  /**
   * What stiffening tissue gives up of its elastic strain, so that the Cauchy
   * stress stays as its shape does: doc/theory.md (6.8b).
   *
   * @param F_e elastic part of the deformation gradient, det F_e > 0
   * @return D, symmetric and positive definite: F_e becomes F_e D⁻¹
   * @throws InputError if no strain has that stress
   */
  template <int dim>
  SymmetricTensor<2, dim>
  given_up_by_stiffening(const Tensor<2, dim> &F_e,
                         const Lame           &before,
                         const Lame           &after,
                         const Material       &material,
                         const bool            per_grown_volume);
} // namespace Morula

#endif
