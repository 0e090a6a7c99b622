// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/nitsche.h>
#include <morula/mechanics/neo_hookean.h>

#include <cmath>

namespace Morula
{
  namespace
  {
    /** M T and its derivative at one boundary point. */
    template <int dim>
    struct NominalTraction
    {
      static constexpr unsigned int n = BSpline<dim>::n;

      Tensor<1, dim> value; // M T
      /** Component k of M DT for component j of spline a: [k][j][a]. */
      double derivative[dim][dim][n];

      NominalTraction(const SplineValues<dim>                &splines,
                      const Tensor<2, dim>                   &f_inverse,
                      const NeoHookean<dim>                  &material,
                      const double                            weight,
                      const typename Nitsche<dim>::Condition &condition)
      {
        const Tensor<1, dim>           m  = condition.normal * f_inverse;
        const SymmetricTensor<2, dim> &b  = material.left_cauchy_green();
        const Tensor<1, dim>           bm = b * m;
        value =
          weight * (condition.projection * (material.kirchhoff_stress() * m));

        const double c2 = material.mu_minus_lambda_log_J();
        for (unsigned int a = 0; a < n; ++a)
          {
            Tensor<1, dim> g; // f⁻ᵀ ∇N_a
            for (unsigned int k = 0; k < dim; ++k)
              for (unsigned int j = 0; j < dim; ++j)
                g[j] += f_inverse[k][j] * splines.gradient[k][a];
            for (unsigned int j = 0; j < dim; ++j)
              {
                // δT for δu = N_a e_j.
                Tensor<1, dim> change =
                  c2 * m[j] * g + material.lambda() * g[j] * m;
                change[j] += material.mu() * (g * bm);
                change = weight * (condition.projection * change);
                for (unsigned int k = 0; k < dim; ++k)
                  derivative[k][j][a] = change[k];
              }
          }
      }
    };

    template <int dim>
    void
    add_forces(const SplineValues<dim>                &splines,
               const NominalTraction<dim>             &T,
               const Tensor<1, dim>                   &gap,
               const typename Nitsche<dim>::Condition &condition,
               LocalSystem<dim>                       &system)
    {
      const double a_t = condition.area, beta = condition.penalty;
      system.add_energy(0.5 * a_t * beta * (gap * gap));
      system.add_energy(-a_t * (T.value * gap));
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
          {
            const double N           = splines.value[a];
            double       consistency = 0.;
            for (unsigned int k = 0; k < dim; ++k)
              consistency += T.derivative[k][i][a] * gap[k];
            system.add_force(i, a, a_t * beta * gap[i] * N);
            system.add_force(i, a, -a_t * (T.value[i] * N + consistency));
            if (system.wanted == LocalSystem<dim>::rounding)
              system.magnitude[i * BSpline<dim>::n + a] +=
                a_t * beta * condition.position_scale * N;
          }
    }

    template <int dim>
    void
    add_tangent(const SplineValues<dim>                &splines,
                const NominalTraction<dim>             &T,
                const typename Nitsche<dim>::Condition &condition,
                LocalSystem<dim>                       &system)
    {
      constexpr unsigned int n      = BSpline<dim>::n;
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      const double           a_t    = condition.area;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int j = 0; j < dim; ++j)
            {
              double *const row = &system.matrix[(i * n + a) * n_dofs + j * n];
              const double  penalty =
                condition.penalty * condition.projection[i][j];
              for (unsigned int b = 0; b < n; ++b)
                row[b] += a_t * (penalty * splines.value[a] * splines.value[b] -
                                 splines.value[a] * T.derivative[i][j][b] -
                                 splines.value[b] * T.derivative[j][i][a]);
            }
    }
  } // namespace

  template <int dim>
  Nitsche<dim>::Nitsche(GroupedPoints<dim>             points,
                        std::vector<Condition>         conditions,
                        std::vector<ElasticState<dim>> current,
                        std::vector<ElasticState<dim>> previous)
    : points(std::move(points))
    , conditions(std::move(conditions))
    , current(std::move(current))
    , previous(std::move(previous))
  {}

  template <int dim>
  void
  Nitsche<dim>::add(const unsigned int     cell,
                    const LocalField<dim> &field,
                    const GrowthAt         growth,
                    LocalSystem<dim>      &system) const
  {
    const auto &states =
      growth == GrowthAt::previous && !previous.empty() ? previous : current;
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
        const Condition           &condition = conditions[p];
        const NeoHookean<dim>      material(F_e, condition.lame);
        const NominalTraction<dim> T(
          splines, invert(f), material, states[p].W, condition);
        if (system.wanted == LocalSystem<dim>::tangent)
          add_tangent(splines, T, condition, system);
        else
          add_forces(splines,
                     T,
                     condition.gap +
                       condition.projection * field.value(splines),
                     condition,
                     system);
      }
  }

  template class Nitsche<2>;
  template class Nitsche<3>;
} // namespace Morula
