// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/neo_hookean.h>

namespace Morula
{
  namespace
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

    template <int dim>
    void
    add_residual(const SpatialGradients<dim> &gradients,
                 const NeoHookean<dim>       &material,
                 const double                 W,
                 LocalSystem<dim>            &system)
    {
      constexpr unsigned int        n   = BSpline<dim>::n;
      const SymmetricTensor<2, dim> tau = W * material.kirchhoff_stress();
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          {
            double force = 0.;
            for (unsigned int j = 0; j < dim; ++j)
              force += tau[i][j] * gradients.g[j][a];
            system.residual[i * n + a] += force;
          }
      system.add_energy(W * material.energy(), W * material.energy_magnitude());
      if (system.wanted == LocalSystem<dim>::rounding)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < n; ++a)
            for (unsigned int j = 0; j < dim; ++j)
              system.magnitude[i * n + a] +=
                std::abs(tau[i][j] * gradients.g[j][a]);
    }

    /**
     * Adds the blocks (i, j), i <= j, of the tangent. The inner loops run over
     * contiguous columns, so that the compiler vectorises them.
     */
    template <int dim>
    void
    add_tangent(const SpatialGradients<dim> &gradients,
                const NeoHookean<dim>       &material,
                const double                 W,
                double                      *matrix)
    {
      constexpr unsigned int         n      = BSpline<dim>::n;
      constexpr unsigned int         n_dofs = LocalSystem<dim>::n_dofs;
      const auto                    &g      = gradients.g;
      const double                   c1     = W * material.lambda();
      const double                   c2 = W * material.mu_minus_lambda_log_J();
      const double                   c3 = W * material.mu();
      const SymmetricTensor<2, dim> &b  = material.left_cauchy_green();

      for (unsigned int a = 0; a < n; ++a)
        {
          double c3_b_g[dim];
          for (unsigned int i = 0; i < dim; ++i)
            {
              c3_b_g[i] = 0.;
              for (unsigned int j = 0; j < dim; ++j)
                c3_b_g[i] += c3 * b[i][j] * g[j][a];
            }
          double geometric[n];
          for (unsigned int c = 0; c < n; ++c)
            {
              geometric[c] = 0.;
              for (unsigned int j = 0; j < dim; ++j)
                geometric[c] += c3_b_g[j] * g[j][c];
            }
          for (unsigned int i = 0; i < dim; ++i)
            {
              double *const diagonal = matrix + (i * n + a) * n_dofs + i * n;
              const double  both     = (c1 + c2) * g[i][a];
              for (unsigned int c = 0; c < n; ++c)
                diagonal[c] += both * g[i][c] + geometric[c];
              for (unsigned int j = i + 1; j < dim; ++j)
                {
                  double *const block = matrix + (i * n + a) * n_dofs + j * n;
                  const double  first = c1 * g[i][a], second = c2 * g[j][a];
                  for (unsigned int c = 0; c < n; ++c)
                    block[c] += first * g[j][c] + second * g[i][c];
                }
            }
        }
    }

    /** Fills the blocks (j, i), j > i, from symmetry. */
    template <int dim>
    void
    add_lower_blocks(const std::vector<double> &upper,
                     std::vector<double>       &matrix)
    {
      constexpr unsigned int n      = BSpline<dim>::n;
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int j = i; j < dim; ++j)
            for (unsigned int c = 0; c < n; ++c)
              {
                const unsigned int row = i * n + a, column = j * n + c;
                matrix[row * n_dofs + column] += upper[row * n_dofs + column];
                if (j > i)
                  matrix[column * n_dofs + row] += upper[row * n_dofs + column];
              }
    }
  } // namespace

  template <int dim>
  InternalForce<dim>::InternalForce(const MaterialPoints<dim> &points)
    : points(points)
  {}

  template <int dim>
  void
  InternalForce<dim>::add(const unsigned int     cell,
                          const LocalField<dim> &field,
                          const GrowthAt         growth,
                          LocalSystem<dim>      &system) const
  {
    const bool          tangent = system.wanted == LocalSystem<dim>::tangent;
    const auto         &states  = points.states(growth);
    std::vector<double> upper(tangent ? system.matrix.size() : 0, 0.);
    for (unsigned int p = points.offsets[cell]; p < points.offsets[cell + 1];
         ++p)
      {
        const SplineValues<dim> splines(points.xi[p], points.h);
        const Tensor<2, dim>    f   = field.step_deformation(splines);
        const Tensor<2, dim>    F_e = f * states[p].A;
        if (determinant(f) <= 0. || determinant(F_e) <= 0.)
          {
            system.inverted = true;
            return;
          }
        const NeoHookean<dim>       material(F_e, points.lame_of(p));
        const SpatialGradients<dim> gradients(splines, invert(f));
        if (tangent)
          add_tangent(gradients, material, states[p].W, upper.data());
        else
          add_residual(gradients, material, states[p].W, system);
      }
    if (tangent)
      add_lower_blocks<dim>(upper, system.matrix);
  }

  template class InternalForce<2>;
  template class InternalForce<3>;
} // namespace Morula
