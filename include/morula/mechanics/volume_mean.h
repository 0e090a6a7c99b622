// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_volume_mean_h
#define morula_mechanics_volume_mean_h

#include <morula/mechanics/materials/response.h>
#include <morula/mechanics/term.h>

namespace Morula
{
  /** The mean of ln J_e over the points of one grid cell, and what follows from
   *  it: doc/theory.md (2.6), (2.7). */
  template <int dim>
  struct VolumeMean
  {
    static constexpr unsigned int n = BSpline<dim>::n;

    double modulus           = 0.; // Λ = Σ W k
    double sum               = 0.; // Σ W k ln J_e
    double gradients[dim][n] = {}; // Σ W k g_a

    /** ϑ; 0 without points. */
    double
    theta() const
    {
      return modulus == 0. ? 0. : sum / modulus;
    }

    /** Energy Λ U(ϑ) and its forces. */
    void
    add_forces(const Volumetric<double> &U, LocalSystem<dim> &system) const
    {
      system.add_energy(modulus * U.energy, modulus * U.magnitude);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          system.add_force(i, a, U.slope * gradients[i][a]);
    }

    /** Λ U'' (Σ W k g_a / Λ)^i (Σ W k g_b / Λ)^j. */
    void
    add_tangent(const Volumetric<double> &U, LocalSystem<dim> &system) const
    {
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      if (modulus == 0.)
        return;
      const double *const all = &gradients[0][0];
      for (unsigned int row = 0; row < n_dofs; ++row)
        {
          const double factor = U.curvature * (all[row] / modulus);
          for (unsigned int column = 0; column < n_dofs; ++column)
            system.matrix[row * n_dofs + column] += factor * all[column];
        }
    }

    /** The derivative of ϑ, 1/µm. */
    LocalField<dim>
    derivative() const
    {
      LocalField<dim> result;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          result.coefficient[i][a] =
            modulus == 0. ? 0. : gradients[i][a] / modulus;
      return result;
    }
  };
} // namespace Morula

#endif
