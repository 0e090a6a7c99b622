// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/nitsche.h>
#include <morula/mechanics/elastic_point.h>

#include <algorithm>
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

    /** T and what its derivatives are made of at one boundary point:
     *  doc/theory.md (4.2), (4.3). It is made once for each point, and all
     *  blocks of the tangent read it. */
    template <int dim>
    struct NominalTraction
    {
      static constexpr unsigned int n = BSpline<dim>::n;
      using Row                       = std::array<double, n>;

      Tensor<1, dim> m;             // f⁻ᵀ n_t
      Tensor<1, dim> bm;            // b_e m
      Row            gradient[dim]; // g = f⁻ᵀ ∇N, by component
      Row            b_g[dim];      // b_e g, of coupled laws
      Row            along_bm;      // b_e m · g
      Tensor<1, dim> value;         // M T

      /** @param coupled whether the law has B, C and D2 to D4 */
      NominalTraction(const SplineValues<dim>                &splines,
                      const Tensor<2, dim>                   &f_inverse,
                      const ElasticPoint<dim>                &state,
                      const PartOfLaw                         part,
                      const bool                              coupled,
                      const double                            weight,
                      const typename Nitsche<dim>::HeldPoint &held)
        // n_t f⁻¹ is f⁻ᵀ n_t.
        : m(held.normal * f_inverse)
        , bm(state.b() * m)
        , weight(weight)
        , of(state.response(), part)
        , coupled(coupled)
      {
        // This is τ m by doc/theory.md (1.8), without making τ.
        const auto tau_m = of.alpha * (bm - m) + of.gamma * m;
        value            = weight * (held.projection * tau_m);
        for (unsigned int j = 0; j < dim; ++j)
          for (unsigned int a = 0; a < n; ++a)
            {
              gradient[j][a] = 0.;
              for (unsigned int k = 0; k < dim; ++k)
                gradient[j][a] += f_inverse[k][j] * splines.gradient[k][a];
            }
        along_bm = along(bm);
        for (unsigned int j = 0; coupled && j < dim; ++j)
          {
            Tensor<1, dim> row;
            for (unsigned int k = 0; k < dim; ++k)
              row[k] = state.b()[j][k];
            b_g[j] = along(row);
          }
      }

      /** v·g for all splines. */
      Row
      along(const Tensor<1, dim> &v) const
      {
        Row row = {};
        for (unsigned int k = 0; k < dim; ++k)
          for (unsigned int a = 0; a < n; ++a)
            row[a] += v[k] * gradient[k][a];
        return row;
      }

      /** q·DT for component j of all splines. */
      Row
      change(const Tensor<1, dim> &q, const unsigned int j) const
      {
        // This is doc/theory.md (4.3) for the vector q. Its products with m and
        // b_e m do not depend on the spline. Coupled laws have the terms with
        // b_e g as well.
        const double of_along = weight * (of.alpha - of.gamma) * m[j],
                     qm = weight * (q * m), qbm = weight * (q * bm),
                     of_along_bm = weight * of.alpha * q[j];
        Row row                  = along(q);
        for (unsigned int a = 0; a < n; ++a)
          row[a] = of_along * row[a] +
                   (of.A * qm + of.B * qbm) * gradient[j][a] +
                   of_along_bm * along_bm[a];
        for (unsigned int a = 0; coupled && a < n; ++a)
          row[a] += (of.B * qm + of.C * qbm) * b_g[j][a];
        return row;
      }

      /** W / V_t. */
      const double weight;
      /** The coefficients of τ. */
      const Coefficients of;
      const bool         coupled;
    };

    /** The list of products of rows of numbers that make up a block of the
     *  tangent. */
    template <int dim>
    class Products
    {
    public:
      /** Adds left(a) right[b]. */
      template <typename Left, typename Row>
      void
      add(const Left &left, const Row &right)
      {
        // Rows are as wide as the kernel wants them, with zeros behind the last
        // spline.
        list.emplace_back();
        auto &[of_left, of_right] = list.back().factors;
        for (unsigned int a = 0; a < SplineProduct<dim>::width; ++a)
          {
            const bool exists = a < BSpline<dim>::n;
            of_left[a]        = exists ? left(a) : 0.;
            of_right[a]       = exists ? right[a] : 0.;
          }
      }

      /** Adds their sum to a block of the tangent, and forgets them. */
      void
      flush(const AddProducts<dim> add_products, double *block)
      {
        add_products(list.data(), list.size(), block, LocalSystem<dim>::n_dofs);
        list.clear();
      }

    private:
      std::vector<SplineProduct<dim>> list;
    };

    /**
     * g·D²T at one boundary point, doc/theory.md (4.5b): for components i, j of
     * the splines a, b it is a sum of a few products of rows.
     */
    template <int dim>
    class SecondDerivative
    {
    public:
      using Row = typename NominalTraction<dim>::Row;

      SecondDerivative(const NominalTraction<dim> &T,
                       const Tensor<1, dim>       &gap,
                       const ThirdDerivatives     &third)
        : T(T)
        , gap(gap)
        , third(third)
        , gm(gap * T.m)
        , gbm(gap * T.bm)
        , along(T.along(gap))
      {}

      /** Adds @p factor times it. */
      void
      add(const unsigned int i,
          const unsigned int j,
          const double       factor,
          Products<dim>     &products) const
      {
        // In doc/theory.md (4.5b) each product of a row by a and a row by b is
        // collected by its right factor: g_b^i, g_b^j, g · g_b, and for coupled
        // laws b_e g_b and b_e m · g_b. So a block takes a few products instead
        // of one for each term.
        const auto  &of = T.of;
        const auto  &g = T.gradient, &bg = T.b_g;
        const auto  &m = T.m;
        const double c = of.alpha - of.gamma, w = factor * T.weight;
        const double of_gm = of.A * gm + of.B * gbm;
        products.add(
          [&](const unsigned int a) {
            return -w * (of_gm * g[j][a] + c * along[a] * m[j]);
          },
          g[i]);
        products.add(
          [&](const unsigned int a) {
            double sum = third.D1 * g[i][a] * gm - of.A * along[a] * m[i];
            if (T.coupled)
              sum += third.D2 * (g[i][a] * gbm + bg[i][a] * gm) +
                     third.D3 * bg[i][a] * gbm + of.B * T.along_bm[a] * gap[i];
            return w * sum;
          },
          g[j]);
        products.add(
          [&](const unsigned int a) {
            const double sum = of.A * g[i][a] * m[j] + c * g[j][a] * m[i];
            return -w * (T.coupled ? sum + of.B * bg[i][a] * m[j] : sum);
          },
          along);
        if (T.coupled)
          add_coupled(i, j, w, products);
      }

    private:
      /** The products with b_e g_b and b_e m · g_b. */
      void
      add_coupled(const unsigned int i,
                  const unsigned int j,
                  const double       w,
                  Products<dim>     &products) const
      {
        const auto &of = T.of;
        const auto &g = T.gradient, &bg = T.b_g;
        products.add(
          [&](const unsigned int a) {
            return w *
                   (third.D2 * g[i][a] * gm +
                    third.D3 * (g[i][a] * gbm + bg[i][a] * gm) +
                    third.D4 * bg[i][a] * gbm + of.C * T.along_bm[a] * gap[i] -
                    of.B * along[a] * T.m[i]);
          },
          bg[j]);
        products.add(
          [&](const unsigned int a) {
            return w * (of.C * bg[i][a] + of.B * g[i][a]) * gap[j];
          },
          T.along_bm);
        // The term with δ^ij stands on the diagonal blocks alone.
        if (i == j)
          for (unsigned int k = 0; k < dim; ++k)
            products.add(
              [&](const unsigned int a) {
                return w * (of.C * gbm + of.B * gm) * g[k][a];
              },
              bg[k]);
      }

      const NominalTraction<dim> T;
      const Tensor<1, dim>       gap;
      const ThirdDerivatives     third;
      const double               gm, gbm; // g·m, g·b_e m
      const Row                  along;   // g·g_b
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
               const typename Nitsche<dim>::HeldPoint &held,
               const double                            sign,
               LocalSystem<dim>                       &system)
    {
      // These are the energy and the residual of doc/theory.md (4.2), (4.4).
      // `consistency` is the variation of T with the sign of the form. The
      // magnitudes know that the gap is a difference of positions, whose
      // rounding is larger than the gap.
      const double a_t = held.area, beta = held.penalty;
      system.add_energy(0.5 * a_t * beta * (gap * gap));
      system.add_energy(-a_t * (T.value * gap));
      for (unsigned int i = 0; i < dim; ++i)
        {
          const auto consistency = T.change(gap * held.projection, i);
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            {
              const double N = splines.value[a];
              system.add_force(i, a, a_t * beta * gap[i] * N);
              system.add_force(i,
                               a,
                               -a_t * (T.value[i] * N + sign * consistency[a]));
              if (system.wanted == LocalSystem<dim>::rounding)
                system.magnitude[i * BSpline<dim>::n + a] +=
                  a_t * beta * held.position_scale * N;
            }
        }
    }

    /** What a point adds to the tangent: doc/theory.md (4.5). */
    template <int dim>
    class TangentOfPoint
    {
    public:
      TangentOfPoint(const SplineValues<dim>                &splines,
                     const NominalTraction<dim>             &T,
                     const Tensor<1, dim>                   &gap,
                     const ThirdDerivatives                 &third,
                     const typename Nitsche<dim>::HeldPoint &held,
                     const double                            sign)
        : second(T, gap, third)
        , held(held)
        , sign(sign)
      {
        std::copy_n(splines.value, N.size(), N.begin());
        // M DT by component: rows of the tangent use it with N_a, columns
        // transposed.
        for (unsigned int k = 0; k < dim; ++k)
          for (unsigned int j = 0; j < dim; ++j)
            derivative[k][j] = T.change(held.projection[k], j);
      }

      /** Adds the products of the block (i, j). */
      void
      add(const unsigned int i,
          const unsigned int j,
          Products<dim>     &products) const
      {
        // This is doc/theory.md (4.5), collected by the right factor: N_b, D_b
        // T, and the second derivative.
        const double a_t     = held.area;
        const double penalty = held.penalty * held.projection[i][j];
        products.add(
          [&](const unsigned int a) {
            return a_t * (penalty * N[a] - sign * derivative[j][i][a]);
          },
          N);
        products.add([&](const unsigned int a) { return -a_t * N[a]; },
                     derivative[i][j]);
        second.add(i, j, -a_t * sign, products);
      }

    private:
      using Row = typename NominalTraction<dim>::Row;

      const SecondDerivative<dim>             second;
      const typename Nitsche<dim>::HeldPoint &held;
      const double                            sign;
      Row                                     N;
      Row derivative[dim][dim]; // component k of M DT for component j
    };
  } // namespace

  template <int dim>
  void
  Nitsche<dim>::add(const unsigned int     cell,
                    const LocalField<dim> &field,
                    const GrowthAt         growth,
                    LocalSystem<dim>      &system) const
  {
    // Points are visited once for energy and residual. For the tangent their
    // parts are kept until all are there, since the blocks are then added one
    // after the other: one block at a time is small enough for the kernel, and
    // all points of the grid cell add to it together. A point far from all
    // cells has no traction, and its deformation, which is extrapolated, is not
    // looked at; only the penalty holds it.
    const auto &states =
      growth == GrowthAt::previous && !previous.empty() ? previous : current;
    std::vector<TangentOfPoint<dim>> tangents;
    for (unsigned int p = points.offsets[cell]; p < points.offsets[cell + 1];
         ++p)
      {
        const SplineValues<dim> splines(points.xi[p], points.h);
        const HeldPoint        &held = held_points[p];
        // An extrapolated deformation may be anything, also inverted.
        const bool           has_traction = held.traction_fraction > 0.;
        const Tensor<2, dim> I            = unit_symmetric_tensor<dim>();
        const Tensor<2, dim> f =
          has_traction ? field.step_deformation(splines) : I;
        const Tensor<2, dim> F_e = has_traction ? f * states[p].A : I;
        if (has_traction &&
            !system.admits(determinant(f), determinant(F_e), points.xi[p]))
          return;
        const ElasticPoint<dim>    state(F_e, held.lame, material);
        const NominalTraction<dim> T(splines,
                                     invert(f),
                                     state,
                                     part,
                                     material.coupled(),
                                     held.traction_fraction * states[p].W,
                                     held);
        const Tensor<1, dim>       gap = held.gap_with(field, splines);
        system.note_gap(gap.norm(), points.xi[p]);
        if (system.wanted == LocalSystem<dim>::tangent)
          tangents.emplace_back(splines,
                                T,
                                gap,
                                material.third_derivatives(state.strain(),
                                                           part),
                                held,
                                sign_of(form));
        else
          add_forces(splines, T, gap, held, sign_of(form), system);
      }
    if (tangents.empty())
      return;
    constexpr unsigned int n = BSpline<dim>::n;
    Products<dim>          products;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        {
          for (const TangentOfPoint<dim> &tangent : tangents)
            tangent.add(i, j, products);
          products.flush(add_products,
                         &system.matrix[i * n * system.n_dofs + j * n]);
        }
  }

  template <int dim>
  std::vector<Tensor<1, dim>>
  Nitsche<dim>::forces(const unsigned int     cell,
                       const LocalField<dim> &field) const
  {
    std::vector<Tensor<1, dim>> list;
    for (unsigned int p = points.offsets[cell]; p < points.offsets[cell + 1];
         ++p)
      {
        const SplineValues<dim> splines(points.xi[p], points.h);
        const HeldPoint        &held = held_points[p];
        const Tensor<1, dim>    gap  = held.gap_with(field, splines);
        Tensor<1, dim>          traction;
        if (held.traction_fraction > 0.)
          {
            const Tensor<2, dim>    f = field.step_deformation(splines);
            const ElasticPoint<dim> state(f * current[p].A,
                                          held.lame,
                                          material);
            traction =
              NominalTraction<dim>(splines,
                                   invert(f),
                                   state,
                                   part,
                                   material.coupled(),
                                   held.traction_fraction * current[p].W,
                                   held)
                .value;
          }
        // The variation of T sums up to nothing in a translation.
        list.push_back(held.area * (traction - held.penalty * gap));
      }
    return list;
  }

  template class Nitsche<2>;
  template class Nitsche<3>;
} // namespace Morula
