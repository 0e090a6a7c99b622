// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_projected_points_h
#define morula_mechanics_projected_points_h

#include <morula/mechanics/neo_hookean.h>
#include <morula/mechanics/term.h>

#include <vector>

namespace Morula
{
  /** Spatial gradients g_a = f⁻ᵀ ∇N_a, by direction. */
  template <int dim>
  struct SpatialGradients
  {
    static constexpr unsigned int n = BSpline<dim>::n;

    double g[dim][n];

    SpatialGradients(const SplineValues<dim> &splines,
                     const Tensor<2, dim>    &f_inverse)
    {
      for (unsigned int j = 0; j < dim; ++j)
        for (unsigned int a = 0; a < n; ++a)
          {
            double sum = 0.;
            for (unsigned int k = 0; k < dim; ++k)
              sum += f_inverse[k][j] * splines.gradient[k][a];
            g[j][a] = sum;
          }
    }
  };

  /** The points of one grid cell whose ln J_e is replaced by its mean:
   *  doc/theory.md (2.6). */
  template <int dim>
  struct ProjectedPoints
  {
    static constexpr unsigned int n = BSpline<dim>::n;

    std::vector<SpatialGradients<dim>> gradients;
    std::vector<NeoHookean<dim>>       materials;
    std::vector<double>                weights; // W

    double stiffness   = 0.; // Σ W λ
    double mean_log_J  = 0.; // ϑ
    double sum[dim][n] = {}; // Σ W λ g_a

    /** Adds a point of the grid cell to Λ, ϑ Λ and the gradients' sum. */
    void
    add(const SpatialGradients<dim> &g,
        const NeoHookean<dim>       &material,
        const double                 W)
    {
      const double weight = W * material.lambda();
      gradients.push_back(g);
      materials.push_back(material);
      weights.push_back(W);
      stiffness += weight;
      mean_log_J += weight * material.log_J(); // its sum until finish()
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          sum[i][a] += weight * g.g[i][a];
    }

    /** After the last point: makes the mean of the sum. */
    void
    finish()
    {
      mean_log_J = stiffness == 0. ? 0. : mean_log_J / stiffness;
    }

    /** Forces and energy of the mean, 1/2 (Σ W λ) ϑ². */
    void
    add_mean_force(LocalSystem<dim> &system) const
    {
      system.add_energy(0.5 * stiffness * mean_log_J * mean_log_J);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          system.add_force(i, a, mean_log_J * sum[i][a]);
    }

    /** The blocks i <= j of (Σ W λ g_a)^i (Σ W λ g_b)^j / Σ W λ. */
    void
    add_mean_tangent(double *matrix) const
    {
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      if (stiffness == 0.)
        return;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int j = i; j < dim; ++j)
            {
              double *const row    = matrix + (i * n + a) * n_dofs + j * n;
              const double  factor = sum[i][a] / stiffness;
              for (unsigned int b = 0; b < n; ++b)
                row[b] += factor * sum[j][b];
            }
    }
  };
} // namespace Morula

#endif
