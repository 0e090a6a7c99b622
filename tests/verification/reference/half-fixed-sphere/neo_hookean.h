// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef half_fixed_sphere_neo_hookean_h
#define half_fixed_sphere_neo_hookean_h

#include <deal.II/base/tensor.h>

#include <cmath>

namespace HalfFixedSphere
{
  using namespace dealii;

  /**
   * The energy per initial volume of a deformation gradient F (3 x 3, in the
   * orthonormal basis r, phi, z) of tissue that has grown by the stretch theta,
   *   Psi = lambda/2 (ln J)^2 + mu/2 (tr b - 3 - 2 ln J)
   * with F_e = F / theta, J = det F_e, b = F_e F_e^T (Yokoyama et al. 2023,
   * eq. 14), and its first two derivatives with respect to F. kPa.
   */
  class NeoHookean
  {
  public:
    NeoHookean(const double        lambda,
               const double        mu,
               const Tensor<2, 3> &F,
               const double        theta)
      : lambda(lambda)
      , mu(mu)
      , theta(theta)
      , F_e(F / theta)
      , J(determinant(F_e))
      , ln_J(std::log(J))
      , F_inverse_T(transpose(invert(F_e)))
    {}

    /** Whether the material is turned inside out: no energy exists. */
    bool
    inverted() const
    {
      return !(J > 0.);
    }

    double
    elastic_volume_ratio() const
    {
      return J;
    }

    double
    energy() const
    {
      return 0.5 * lambda * ln_J * ln_J +
             0.5 * mu * (F_e.norm_square() - 3. - 2. * ln_J);
    }

    /** The first Piola-Kirchhoff stress P = dPsi/dF. */
    Tensor<2, 3>
    stress() const
    {
      return (mu * (F_e - F_inverse_T) + lambda * ln_J * F_inverse_T) / theta;
    }

    /** The change of P when F changes by dF. */
    Tensor<2, 3>
    stress_change(const Tensor<2, 3> &dF) const
    {
      const Tensor<2, 3> X = F_inverse_T * transpose(dF) * F_inverse_T;
      return (mu * dF + (mu - lambda * ln_J) * X +
              lambda * scalar_product(F_inverse_T, dF) * F_inverse_T) /
             (theta * theta);
    }

  private:
    double       lambda, mu, theta;
    Tensor<2, 3> F_e;
    double       J, ln_J;
    Tensor<2, 3> F_inverse_T;
  };
} // namespace HalfFixedSphere

#endif
