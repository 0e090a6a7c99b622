// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/projected_points.h>

namespace Morula
{
  namespace
  {
    /** @param tau W τ */
    template <int dim>
    void
    add_stress(const SpatialGradients<dim>   &gradients,
               const SymmetricTensor<2, dim> &tau,
               LocalSystem<dim>              &system)
    {
      constexpr unsigned int n = BSpline<dim>::n;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          {
            double force = 0.;
            for (unsigned int j = 0; j < dim; ++j)
              force += tau[i][j] * gradients.g[j][a];
            system.residual[i * n + a] += force;
          }
      if (system.wanted == LocalSystem<dim>::rounding)
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < n; ++a)
            for (unsigned int j = 0; j < dim; ++j)
              system.magnitude[i * n + a] +=
                std::abs(tau[i][j] * gradients.g[j][a]);
    }

    /**
     * Adds the blocks (i, j), i <= j, of the tangent c1 g_a^i g_b^j + c2 g_a^j
     * g_b^i + c3 (g_a · b g_b) δ^ij. The inner loops run over contiguous
     * columns, so that the compiler vectorises them.
     */
    template <int dim>
    void
    add_tangent(const SpatialGradients<dim>   &gradients,
                const SymmetricTensor<2, dim> &b,
                const double                   c1,
                const double                   c2,
                const double                   c3,
                double                        *matrix)
    {
      constexpr unsigned int n      = BSpline<dim>::n;
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      const auto            &g      = gradients.g;

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
  InternalForce<dim>::InternalForce(const MaterialPoints<dim> &points,
                                    const VolumetricStrain     form)
    : points(points)
    , form(form)
  {}

  template <int dim>
  template <typename Visit>
  bool
  InternalForce<dim>::for_each_point(const unsigned int     grid_cell,
                                     const LocalField<dim> &field,
                                     const GrowthAt         growth,
                                     LocalSystem<dim>      &system,
                                     const Visit           &visit) const
  {
    const auto &states = points.states(growth);
    for (unsigned int p = points.offsets[grid_cell];
         p < points.offsets[grid_cell + 1];
         ++p)
      {
        const SplineValues<dim> splines(points.xi[p], points.h);
        const Tensor<2, dim>    f   = field.step_deformation(splines);
        const Tensor<2, dim>    F_e = f * states[p].A;
        if (!system.admits(determinant(f), determinant(F_e), points.xi[p]))
          return false;
        visit(SpatialGradients<dim>(splines, invert(f)),
              NeoHookean<dim>(F_e, points.lame_of(p)),
              states[p].W);
      }
    return true;
  }

  template <int dim>
  bool
  InternalForce<dim>::add_pointwise(const unsigned int     grid_cell,
                                    const LocalField<dim> &field,
                                    const GrowthAt         growth,
                                    double                *tangent,
                                    LocalSystem<dim>      &system) const
  {
    return for_each_point(
      grid_cell,
      field,
      growth,
      system,
      [&](const SpatialGradients<dim> &gradients,
          const NeoHookean<dim>       &material,
          const double                 W) {
        if (tangent != nullptr)
          {
            add_tangent(gradients,
                        material.left_cauchy_green(),
                        W * material.lambda(),
                        W * material.mu_minus_lambda_log_J(),
                        W * material.mu(),
                        tangent);
            return;
          }
        add_stress(gradients, W * material.kirchhoff_stress(), system);
        system.add_energy(W * material.energy(),
                          W * material.energy_magnitude());
      });
  }

  template <int dim>
  bool
  InternalForce<dim>::project(const unsigned int     grid_cell,
                              const LocalField<dim> &field,
                              const GrowthAt         growth,
                              LocalSystem<dim>      &system,
                              ProjectedPoints<dim>  &projected) const
  {
    const bool valid =
      for_each_point(grid_cell,
                     field,
                     growth,
                     system,
                     [&](const SpatialGradients<dim> &gradients,
                         const NeoHookean<dim>       &material,
                         const double                 W) {
                       projected.add(gradients, material, W);
                     });
    projected.finish();
    return valid;
  }

  template <int dim>
  VolumeLinearisation<dim>
  InternalForce<dim>::linearisation(const unsigned int          grid_cell,
                                    const LocalField<dim>      &field,
                                    const GrowthAt              growth,
                                    const ProjectedPoints<dim> &projected) const
  {
    VolumeLinearisation<dim> result;
    result.field = field;
    // What the next residual is of: the growth at t + dt.
    result.value = growth == GrowthAt::current ?
                     projected.mean_log_J :
                     mean_log_volume_ratio(grid_cell, field);
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
        result.derivative.coefficient[i][a] =
          projected.stiffness == 0. ? 0. :
                                      projected.sum[i][a] / projected.stiffness;
    return result;
  }

  template <int dim>
  bool
  InternalForce<dim>::add_projected(const unsigned int     grid_cell,
                                    const LocalField<dim> &field,
                                    const GrowthAt         growth,
                                    double                *tangent,
                                    LocalSystem<dim>      &system) const
  {
    ProjectedPoints<dim> projected;
    if (!project(grid_cell, field, growth, system, projected))
      return false;
    const double theta =
      system.last ? system.last->at(field) : projected.mean_log_J;
    if (tangent != nullptr)
      system.linearisation = linearisation(grid_cell, field, growth, projected);
    for (unsigned int k = 0; k < projected.materials.size(); ++k)
      {
        const SpatialGradients<dim> &gradients = projected.gradients[k];
        const NeoHookean<dim>       &material  = projected.materials[k];
        const double                 W         = projected.weights[k];
        if (tangent != nullptr)
          {
            add_tangent(gradients,
                        material.left_cauchy_green(),
                        0.,
                        W * (material.mu() - material.lambda() * theta),
                        W * material.mu(),
                        tangent);
            continue;
          }
        add_stress(gradients, W * material.shear_stress(), system);
        system.add_energy(W * material.shear_energy(),
                          W * material.shear_energy_magnitude());
      }
    if (tangent != nullptr)
      projected.add_mean_tangent(tangent);
    else
      projected.add_mean_force(system);
    return true;
  }

  template <int dim>
  void
  InternalForce<dim>::add(const unsigned int     grid_cell,
                          const LocalField<dim> &field,
                          const GrowthAt         growth,
                          LocalSystem<dim>      &system) const
  {
    const bool wants_tangent = system.wanted == LocalSystem<dim>::tangent;
    std::vector<double> upper(wants_tangent ? system.matrix.size() : 0, 0.);
    double *const       tangent = wants_tangent ? upper.data() : nullptr;
    const bool          valid =
      form == VolumetricStrain::pointwise ?
                 add_pointwise(grid_cell, field, growth, tangent, system) :
                 add_projected(grid_cell, field, growth, tangent, system);
    if (valid && wants_tangent)
      add_lower_blocks<dim>(upper, system.matrix);
  }

  template <int dim>
  double
  InternalForce<dim>::mean_log_volume_ratio(const unsigned int     grid_cell,
                                            const LocalField<dim> &field) const
  {
    ProjectedPoints<dim> projected;
    LocalSystem<dim>     unused(LocalSystem<dim>::energy_and_residual);
    project(grid_cell, field, GrowthAt::current, unused, projected);
    return projected.mean_log_J;
  }

  template class InternalForce<2>;
  template class InternalForce<3>;
} // namespace Morula
