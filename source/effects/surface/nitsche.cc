// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/nitsche.h>
#include <morula/mechanics/neo_hookean.h>

#include <array>

namespace Morula
{
  namespace
  {
    /** T and its derivatives at one boundary point: doc/theory.md (4.2), (4.3).
     */
    template <int dim>
    struct NominalTraction
    {
      static constexpr unsigned int n = BSpline<dim>::n;

      Tensor<1, dim> m;                // f⁻ᵀ n_t
      double         gradient[dim][n]; // f⁻ᵀ ∇N_a, by component
      Tensor<1, dim> value;            // M T
      /** Component k of M DT for component j of spline a: [k][j][a]. */
      double derivative[dim][dim][n];

      NominalTraction(const SplineValues<dim>                &splines,
                      const Tensor<2, dim>                   &f_inverse,
                      const NeoHookean<dim>                  &material,
                      const double                            weight,
                      const typename Nitsche<dim>::Condition &condition)
        : m(condition.normal * f_inverse)
        , weight(weight)
        , lambda(material.lambda())
        , c2(material.mu_minus_lambda_log_J())
      {
        const Tensor<1, dim> bm = material.left_cauchy_green() * m;
        value =
          weight * (condition.projection * (material.kirchhoff_stress() * m));
        for (unsigned int a = 0; a < n; ++a)
          {
            Tensor<1, dim> g;
            for (unsigned int k = 0; k < dim; ++k)
              for (unsigned int j = 0; j < dim; ++j)
                g[j] += f_inverse[k][j] * splines.gradient[k][a];
            for (unsigned int j = 0; j < dim; ++j)
              {
                // δT for δu = N_a e_j.
                Tensor<1, dim> change = c2 * m[j] * g + lambda * g[j] * m;
                change[j] += material.mu() * (g * bm);
                change = weight * (condition.projection * change);
                for (unsigned int k = 0; k < dim; ++k)
                  derivative[k][j][a] = change[k];
                gradient[j][a] = g[j];
              }
          }
      }

      /**
       * g·D²T for component i of spline a and component j of spline b,
       * doc/theory.md (4.5b), is, for all b, a sum of three rows times these
       * factors.
       */
      struct SecondDerivative
      {
        double gi, gj, along; // of gradient[i], gradient[j] and g·f⁻ᵀ∇N_b
      };

      /** @param along g·f⁻ᵀ∇N_a */
      SecondDerivative
      second_derivative(const Tensor<1, dim> &gap,
                        const double          along,
                        const unsigned int    i,
                        const unsigned int    a,
                        const unsigned int    j) const
      {
        const double gm = gap * m;
        return {-weight * (lambda * gm * gradient[j][a] + c2 * along * m[j]),
                -weight * lambda * along * m[i],
                -weight * (lambda * gradient[i][a] * m[j] +
                           c2 * gradient[j][a] * m[i])};
      }

    private:
      const double weight, lambda, c2;
    };

    /** The sign of g·DT[δu] in -R. */
    double
    sign_of(const NitscheForm form)
    {
      return form == NitscheForm::symmetric ? 1. : -1.;
    }

    template <int dim>
    void
    add_forces(const SplineValues<dim>                &splines,
               const NominalTraction<dim>             &T,
               const Tensor<1, dim>                   &gap,
               const typename Nitsche<dim>::Condition &condition,
               const double                            sign,
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
            system.add_force(i,
                             a,
                             -a_t * (T.value[i] * N + sign * consistency));
            if (system.wanted == LocalSystem<dim>::rounding)
              system.magnitude[i * BSpline<dim>::n + a] +=
                a_t * beta * condition.position_scale * N;
          }
    }

    /** doc/theory.md (4.5). */
    template <int dim>
    void
    add_tangent(const SplineValues<dim>                &splines,
                const NominalTraction<dim>             &T,
                const Tensor<1, dim>                   &gap,
                const typename Nitsche<dim>::Condition &condition,
                const double                            sign,
                LocalSystem<dim>                       &system)
    {
      constexpr unsigned int n      = BSpline<dim>::n;
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      const double           a_t    = condition.area;
      std::array<double, n>  along{};
      for (unsigned int b = 0; b < n; ++b)
        for (unsigned int k = 0; k < dim; ++k)
          along[b] += gap[k] * T.gradient[k][b];
      const auto &N = splines.value;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int j = 0; j < dim; ++j)
            {
              double *const row = &system.matrix[(i * n + a) * n_dofs + j * n];
              const auto   second = T.second_derivative(gap, along[a], i, a, j);
              const double of_N =
                a_t * (condition.penalty * condition.projection[i][j] * N[a] -
                       sign * T.derivative[j][i][a]);
              for (unsigned int b = 0; b < n; ++b)
                row[b] +=
                  of_N * N[b] - a_t * N[a] * T.derivative[i][j][b] -
                  a_t * sign *
                    (second.gi * T.gradient[i][b] +
                     second.gj * T.gradient[j][b] + second.along * along[b]);
            }
    }
  } // namespace

  template <int dim>
  Nitsche<dim>::Nitsche(const NitscheForm              form,
                        GroupedPoints<dim>             points,
                        std::vector<Condition>         conditions,
                        std::vector<ElasticState<dim>> current,
                        std::vector<ElasticState<dim>> previous)
    : form(form)
    , points(std::move(points))
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
        const Condition        &condition = conditions[p];
        // An extrapolated deformation may be anything, also inverted.
        const bool           trusted = condition.trust > 0.;
        const Tensor<2, dim> I       = unit_symmetric_tensor<dim>();
        const Tensor<2, dim> f = trusted ? field.step_deformation(splines) : I;
        const Tensor<2, dim> F_e = trusted ? f * states[p].A : I;
        if (trusted &&
            !system.admits(determinant(f), determinant(F_e), points.xi[p]))
          return;
        const NeoHookean<dim>      material(F_e, condition.lame);
        const NominalTraction<dim> T(splines,
                                     invert(f),
                                     material,
                                     condition.trust * states[p].W,
                                     condition);
        const Tensor<1, dim>       gap =
          condition.gap + condition.projection * field.value(splines);
        system.note_gap(gap.norm(), points.xi[p]);
        if (system.wanted == LocalSystem<dim>::tangent)
          add_tangent(splines, T, gap, condition, sign_of(form), system);
        else
          add_forces(splines, T, gap, condition, sign_of(form), system);
      }
  }

  template <int dim>
  bool
  Nitsche<dim>::is_conservative() const
  {
    return form == NitscheForm::symmetric;
  }

  template class Nitsche<2>;
  template class Nitsche<3>;
} // namespace Morula
