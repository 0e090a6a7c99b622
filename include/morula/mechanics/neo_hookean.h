// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_neo_hookean_h
#define morula_mechanics_neo_hookean_h

#include <morula/mechanics/material.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <cmath>

namespace Morula
{
  using namespace dealii;

  /**
   * The compressible neo-Hookean material of equation (14) of the paper,
   * doc/theory.md (1.4), (1.5), at one point: energy, stress and the numbers
   * its tangent is made of. In 2-D (plane strain) the 3-D energy with F_e,zz
   * = 1.
   *
   *   Ψ = λ/2 (ln J_e)² + μ/2 (tr b_e - 3 - 2 ln J_e),
   *   τ = μ (b_e - I) + λ ln J_e I.
   */
  template <int dim>
  class NeoHookean
  {
  public:
    /** @param F_e elastic part of the deformation gradient, det F_e > 0 */
    NeoHookean(const Tensor<2, dim> &F_e, const Lame &lame)
      : lame(lame)
      , b(symmetrize(F_e * transpose(F_e)))
      , J_(determinant(F_e))
      , log_J_(std::log(J_))
    {}

    /** J_e. */
    double
    J() const
    {
      return J_;
    }

    /** b_e = F_e F_eᵀ. */
    const SymmetricTensor<2, dim> &
    left_cauchy_green() const
    {
      return b;
    }

    /** ln J_e. */
    double
    log_J() const
    {
      return log_J_;
    }

    /** Ψ, kPa. */
    double
    energy() const
    {
      return 0.5 * lame.lambda * log_J_ * log_J_ + shear_energy();
    }

    /** The part of Ψ with μ, kPa. */
    double
    shear_energy() const
    {
      return 0.5 * lame.mu * (trace(b) - dim - 2. * log_J_);
    }

    /** Size of what Ψ is a difference of, for its rounding error, kPa. */
    double
    energy_magnitude() const
    {
      return 0.5 * lame.lambda * log_J_ * log_J_ + shear_energy_magnitude();
    }

    /** The same for the part of Ψ with μ, kPa. */
    double
    shear_energy_magnitude() const
    {
      return 0.5 * lame.mu * (trace(b) + dim + 2. * std::abs(log_J_));
    }

    /** The part of the Kirchhoff stress τ in the plane (3-D: all of it), kPa.
     */
    SymmetricTensor<2, dim>
    kirchhoff_stress() const
    {
      return shear_stress() +
             lame.lambda * log_J_ * unit_symmetric_tensor<dim>();
    }

    /** The part of τ with μ, kPa. */
    SymmetricTensor<2, dim>
    shear_stress() const
    {
      return lame.mu * (b - unit_symmetric_tensor<dim>());
    }

    /** τ_zz, also in plane strain, kPa. */
    double
    kirchhoff_stress_zz() const
    {
      return dim == 3 ? kirchhoff_stress()[dim - 1][dim - 1] :
                        lame.lambda * log_J_;
    }

    /** λ. */
    double
    lambda() const
    {
      return lame.lambda;
    }

    /** μ - λ ln J_e, the second coefficient of the tangent. */
    double
    mu_minus_lambda_log_J() const
    {
      return lame.mu - lame.lambda * log_J_;
    }

    /** μ. */
    double
    mu() const
    {
      return lame.mu;
    }

  private:
    Lame                    lame;
    SymmetricTensor<2, dim> b;
    double                  J_;
    double                  log_J_;
  };
} // namespace Morula

#endif
