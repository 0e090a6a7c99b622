// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/nitsche.h>
#include <morula/mechanics/elastic_point.h>

#include <array>

namespace Morula
{
  namespace
  {
    /** The coefficients of the stress and its derivative, (1.5), (2.5). */
    struct Coefficients
    {
      double alpha, gamma, A, B, C;

      Coefficients(const CoupledResponse<double> &r, const PartOfLaw part)
        : alpha(r.alpha)
        , gamma(part == PartOfLaw::all ? r.total_gamma() : r.gamma)
        , A(part == PartOfLaw::all ? r.total_A() : r.A)
        , B(r.B)
        , C(r.C)
      {}
    };

    /** T and its derivatives at one boundary point: doc/theory.md (4.2), (4.3).
     */
    template <int dim>
    struct NominalTraction
    {
      static constexpr unsigned int n = BSpline<dim>::n;
      using Row                       = std::array<double, n>;

      Tensor<1, dim> m;             // f⁻ᵀ n_t
      Tensor<1, dim> bm;            // b_e m
      Row            gradient[dim]; // g = f⁻ᵀ ∇N, by component
      Row            b_g[dim];      // b_e g
      Tensor<1, dim> value;         // M T
      /** Component k of M DT for component j of spline a: [k][j][a]. */
      Row derivative[dim][dim];

      NominalTraction(const SplineValues<dim>                &splines,
                      const Tensor<2, dim>                   &f_inverse,
                      const ElasticPoint<dim>                &state,
                      const PartOfLaw                         part,
                      const double                            weight,
                      const typename Nitsche<dim>::Condition &condition)
        : m(condition.normal * f_inverse)
        , bm(state.b() * m)
        , weight(weight)
        , of(state.response(), part)
      {
        const auto tau_m = of.alpha * (bm - m) + of.gamma * m;
        value            = weight * (condition.projection * tau_m);
        for (unsigned int a = 0; a < n; ++a)
          {
            Tensor<1, dim> g;
            for (unsigned int k = 0; k < dim; ++k)
              for (unsigned int j = 0; j < dim; ++j)
                g[j] += f_inverse[k][j] * splines.gradient[k][a];
            const Tensor<1, dim> bg = state.b() * g;
            for (unsigned int j = 0; j < dim; ++j)
              {
                // δT for δu = N_a e_j.
                Tensor<1, dim> change = (of.alpha - of.gamma) * m[j] * g +
                                        (of.A * g[j] + of.B * bg[j]) * m +
                                        (of.B * g[j] + of.C * bg[j]) * bm;
                change[j] += of.alpha * (g * bm);
                change = weight * (condition.projection * change);
                for (unsigned int k = 0; k < dim; ++k)
                  derivative[k][j][a] = change[k];
                gradient[j][a] = g[j];
                b_g[j][a]      = bg[j];
              }
          }
      }

      /** W / V_t. */
      const double weight;
      /** Those of τ. */
      const Coefficients of;
    };

    /**
     * g·D²T at one boundary point, doc/theory.md (4.5b): for component i of
     * spline a, component j and all splines b it is a sum of a few rows.
     */
    template <int dim>
    class SecondDerivative
    {
    public:
      static constexpr unsigned int n = BSpline<dim>::n;
      using Row                       = std::array<double, n>;

      /** @param coupled whether the law has B, C and D2 to D4 */
      SecondDerivative(const NominalTraction<dim> &T,
                       const Tensor<1, dim>       &gap,
                       const ThirdDerivatives     &third,
                       const bool                  coupled)
        : T(T)
        , gap(gap)
        , third(third)
        , coupled(coupled)
        , gm(gap * T.m)
        , gbm(gap * T.bm)
      {
        for (unsigned int b = 0; b < n; ++b)
          {
            along[b] = along_bm[b] = 0.;
            for (unsigned int k = 0; k < dim; ++k)
              {
                along[b] += gap[k] * T.gradient[k][b];
                along_bm[b] += T.bm[k] * T.gradient[k][b];
              }
          }
      }

      /** Adds @p factor times it, for all b. */
      void
      add(const unsigned int i,
          const unsigned int a,
          const unsigned int j,
          const double       factor,
          double            *row) const
      {
        const auto  &of = T.of;
        const auto  &g  = T.gradient;
        const double c  = of.alpha - of.gamma;
        const double w  = factor * T.weight;
        const double of_gi =
          -w * ((of.A * gm + of.B * gbm) * g[j][a] + c * along[a] * T.m[j]);
        const double of_gj =
          w * (third.D1 * g[i][a] * gm - of.A * along[a] * T.m[i]);
        const double of_along =
          -w * (of.A * g[i][a] * T.m[j] + c * g[j][a] * T.m[i]);
        for (unsigned int b = 0; b < n; ++b)
          row[b] += of_gi * g[i][b] + of_gj * g[j][b] + of_along * along[b];
        if (coupled)
          add_coupled(i, a, j, w, row);
      }

    private:
      /** The parts with B, C and D2 to D4, but for that with g_b^i. */
      void
      add_coupled(const unsigned int i,
                  const unsigned int a,
                  const unsigned int j,
                  const double       w,
                  double            *row) const
      {
        const auto  &of = T.of;
        const auto  &g = T.gradient, &bg = T.b_g;
        const double of_gj =
          w * (third.D2 * (g[i][a] * gbm + bg[i][a] * gm) +
               third.D3 * bg[i][a] * gbm + of.B * along_bm[a] * gap[i]);
        const double of_bgj =
          w * (third.D2 * g[i][a] * gm +
               third.D3 * (g[i][a] * gbm + bg[i][a] * gm) +
               third.D4 * bg[i][a] * gbm + of.C * along_bm[a] * gap[i] -
               of.B * along[a] * T.m[i]);
        const double of_along = -w * of.B * bg[i][a] * T.m[j];
        const double of_along_bm =
          w * (of.C * bg[i][a] + of.B * g[i][a]) * gap[j];
        for (unsigned int b = 0; b < n; ++b)
          row[b] += of_gj * g[j][b] + of_bgj * bg[j][b] + of_along * along[b] +
                    of_along_bm * along_bm[b];
        if (i == j)
          for (unsigned int k = 0; k < dim; ++k)
            {
              const double of_bg = w * (of.C * gbm + of.B * gm) * g[k][a];
              for (unsigned int b = 0; b < n; ++b)
                row[b] += of_bg * bg[k][b];
            }
      }

      const NominalTraction<dim> &T;
      const Tensor<1, dim>       &gap;
      const ThirdDerivatives     &third;
      const bool                  coupled;
      const double                gm, gbm;         // g·m, g·b_e m
      Row                         along, along_bm; // g·g_b, (b_e m)·g_b
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
                const SecondDerivative<dim>            &second,
                const typename Nitsche<dim>::Condition &condition,
                const double                            sign,
                LocalSystem<dim>                       &system)
    {
      constexpr unsigned int n      = BSpline<dim>::n;
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      const double           a_t    = condition.area;
      const auto            &N      = splines.value;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int j = 0; j < dim; ++j)
            {
              double *const row = &system.matrix[(i * n + a) * n_dofs + j * n];
              const double  of_N =
                a_t * (condition.penalty * condition.projection[i][j] * N[a] -
                       sign * T.derivative[j][i][a]);
              for (unsigned int b = 0; b < n; ++b)
                row[b] += of_N * N[b] - a_t * N[a] * T.derivative[i][j][b];
              second.add(i, a, j, -a_t * sign, row);
            }
    }
  } // namespace

  template <int dim>
  Nitsche<dim>::Nitsche(const NitscheForm              form,
                        const Material                &material,
                        const PartOfLaw                part,
                        GroupedPoints<dim>             points,
                        std::vector<Condition>         conditions,
                        std::vector<ElasticState<dim>> current,
                        std::vector<ElasticState<dim>> previous)
    : form(form)
    , material(material)
    , part(part)
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
        const ElasticPoint<dim>    state(F_e, condition.lame, material);
        const NominalTraction<dim> T(splines,
                                     invert(f),
                                     state,
                                     part,
                                     condition.trust * states[p].W,
                                     condition);
        const Tensor<1, dim>       gap =
          condition.gap + condition.projection * field.value(splines);
        system.note_gap(gap.norm(), points.xi[p]);
        if (system.wanted == LocalSystem<dim>::tangent)
          {
            const ThirdDerivatives third =
              material.third_derivatives(state.strain(), part);
            add_tangent(
              splines,
              T,
              SecondDerivative<dim>(T, gap, third, material.coupled()),
              condition,
              sign_of(form),
              system);
          }
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
