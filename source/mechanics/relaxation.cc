// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/mechanics/elastic_point.h>
#include <morula/mechanics/relaxation.h>

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <array>
#include <cstdint>

namespace Morula
{
  namespace
  {
    /** Principal values of b_e or C_e, divided by J_e^(2/dim): their product is
     *  1. */
    template <int dim>
    using Isochoric = std::array<double, dim>;


    /** c / (v + (1 - v) c), scaled to the product 1: doc/theory.md (8.3) with g
     * = (1 - v) / v, which may be infinite. */
    template <int dim>
    Isochoric<dim>
    relaxed(const Isochoric<dim> &c, const double v)
    {
      Isochoric<dim> result;
      double         product = 1.;
      for (unsigned int i = 0; i < dim; ++i)
        {
          result[i] = c[i] / (v + (1. - v) * c[i]);
          product *= result[i];
        }
      // A flow keeps the volume, so the product of the principal values has to
      // stay 1.
      const double scale = std::pow(product, -1. / dim);
      for (double &value : result)
        value *= scale;
      return result;
    }


    /** Gives the von Mises stress of a point whose volume is held. */
    template <int dim>
    class ShearStress
    {
    public:
      ShearStress(const double J, const Lame &lame, const Material &material)
        : J(J)
        , factor(std::pow(J, 2. / dim))
        , lame(lame)
        , material(material)
      {}

      double
      operator()(const Isochoric<dim> &c) const
      {
        // The stress depends on c by its deviator and on α(tr b_e, J_e). tr b_e
        // - 3 is factor * trace - dim also in 2-D, where b_e,zz is 1.
        double trace = 0.;
        for (const double value : c)
          trace += value;
        double square = 0.; // of dev c
        for (const double value : c)
          square += (value - trace / dim) * (value - trace / dim);
        const double log_J = std::log(J);
        const double alpha = material
                               .response({factor * trace - dim,
                                          factor * trace + dim,
                                          J,
                                          log_J,
                                          log_J,
                                          lame.lambda,
                                          lame.mu})
                               .alpha;
        return std::sqrt(1.5 * square) * alpha * factor;
      }

    private:
      double          J, factor;
      const Lame     &lame;
      const Material &material;
    };


    /**
     * v of relaxed() after the time @p gamma, in relaxation times, by the flow
     * of doc/theory.md (8.1), (8.2) where nothing yields: e^{-s} with g = e^s -
     * 1 of doc/theory.md (8.2a). That equation is integrated by Runge's and
     * Kutta's classical rule; near the end ds/dγ = 1. For small strains that
     * holds all the time.
     */
    template <int dim>
    double
    what_stays_of_exact_flow(const Isochoric<dim> &c, const double gamma)
    {
      // The slope is smooth and tends to 1, so that steps of half a relaxation
      // time are short ones. After 40 relaxation times e^{-s} is below
      // rounding, and the rest of the time is added to s as it is.
      constexpr double longest = 0.5, nearly_all = 40.;
      const auto       slope = [&c](const double s) {
        double product = 1.;
        for (unsigned int i = 0; i < dim; ++i)
          product *= 1. + std::exp(-s) * (1. / c[i] - 1.);
        return dim == 3 ? std::cbrt(product) : std::sqrt(product);
      };
      const double       part    = std::min(gamma, nearly_all);
      const unsigned int n_steps = std::ceil(part / longest);
      const double       h       = n_steps > 0 ? part / n_steps : 0.;
      double             s       = 0.;
      for (unsigned int n = 0; n < n_steps; ++n)
        {
          const double k1 = slope(s), k2 = slope(s + 0.5 * h * k1),
                       k3 = slope(s + 0.5 * h * k2), k4 = slope(s + h * k3);
          s += h / 6. * (k1 + 2. * k2 + 2. * k3 + k4);
        }
      return std::exp(-(s + (gamma - part)));
    }


    /** The principal stresses of strains, kPa, and their derivatives. */
    template <int dim>
    struct PrincipalStress
    {
      Tensor<1, dim> stress;
      Tensor<2, dim> slope;

      /** @param x logarithms of the principal stretches of F_e */
      PrincipalStress(const Tensor<1, dim> &x,
                      const Lame           &lame,
                      const Material       &material,
                      const bool            per_grown_volume)
      {
        // These are τ and its derivative in principal directions, as in
        // doc/theory.md (2.5), divided by J_e where σ is τ / J_e. Where the
        // energy is counted per initial volume F_g does not count in σ.
        Tensor<2, dim> F_e;
        double         log_J = 0.;
        for (unsigned int i = 0; i < dim; ++i)
          {
            F_e[i][i] = std::exp(x[i]);
            log_J += x[i];
          }
        const ElasticPoint<dim> point(F_e, lame, material);
        const auto             &r   = point.response();
        const double            w   = per_grown_volume ? std::exp(-log_J) : 1.;
        const auto              tau = point.kirchhoff_stress();
        for (unsigned int i = 0; i < dim; ++i)
          {
            const double b = point.b()[i][i];
            stress[i]      = w * tau[i][i];
            for (unsigned int j = 0; j < dim; ++j)
              {
                const double b_j = point.b()[j][j];
                slope[i][j] =
                  w * (r.total_A() + r.B * (b + b_j) + r.C * b * b_j +
                       (i == j ? 2. * r.alpha * b : 0.)) -
                  (per_grown_volume ? stress[i] : 0.);
              }
          }
      }
    };


    /**
     * v of relaxed() for @p dt: exact, but with a yield stress the root of
     * backward Euler, doc/theory.md (8.5). Between complete relaxation, where
     * the stress is below the yield stress, and none, where it is above, there
     * is a root, and only one where the stress falls as c relaxes.
     */
    template <int dim>
    double
    what_stays(const Isochoric<dim>   &c,
               const ShearStress<dim> &stress,
               const FlowLaw          &flow,
               const double            dt)
    {
      const double tau = flow.relaxation_time;
      // Without a yield stress the flow is exact for any step.
      if (flow.yield_stress <= 0.)
        return what_stays_of_exact_flow<dim>(c, dt / tau);
      const double v = tau / (tau + dt);
      // Below the yield stress nothing flows. Above it the root of
      // doc/theory.md (8.5) lies between v = tau / (tau + dt), the root without
      // a yield stress, and 1, no flow.
      if (stress(c) <= flow.yield_stress)
        return 1.;
      const auto residual = [&](const double v) {
        const double m = stress(relaxed<dim>(c, v));
        return (1. - v) * tau * m - v * dt * (m - flow.yield_stress);
      };
      // The yield stress is below rounding: the residual has no change of sign,
      // and the flow is that without one.
      if (!(residual(v) > 0.))
        return v;
      // The bound is a guard only.
      std::uintmax_t iterations = 100;
      const auto [below, above] = boost::math::tools::toms748_solve(
        residual,
        v,
        1.,
        residual(v),
        -dt * (stress(c) - flow.yield_stress),
        boost::math::tools::eps_tolerance<double>(),
        iterations);
      return 0.5 * (below + above);
    }
  } // namespace


  double
  weight_of_end(const double gamma)
  {
    // Below this the difference has fewer digits than the series.
    // At 10⁻³ the series is wrong by γ³/720, the difference by rounding over γ:
    // both are below 10⁻¹¹.
    constexpr double small = 1e-3;
    return gamma < small ? 0.5 + gamma / 12. :
                           -1. / std::expm1(-gamma) - 1. / gamma;
  }


  template <int dim>
  double
  von_mises_stress(const Tensor<2, dim> &F_e,
                   const Lame           &lame,
                   const Material       &material)
  {
    const double   J = determinant(F_e);
    const auto     c = eigenvalues(symmetrize(transpose(F_e) * F_e));
    Isochoric<dim> isochoric;
    for (unsigned int i = 0; i < dim; ++i)
      isochoric[i] = c[i] * std::pow(J, -2. / dim);
    return ShearStress<dim>(J, lame, material)(isochoric);
  }


  template <int dim>
  SymmetricTensor<2, dim>
  flow_of_step(const Tensor<2, dim> &F_e,
               const Lame           &lame,
               const Material       &material,
               const FlowLaw        &flow,
               const double          dt)
  {
    // The flow is coaxial with C_e = F_eᵀ F_e. So its principal values are what
    // relaxes, at constant J_e and constant directions; what is left of each
    // gives the stretch of D along its direction: doc/theory.md (8.4).
    const auto C       = eigenvectors(symmetrize(transpose(F_e) * F_e));
    double     product = 1.; // J_e²
    for (const auto &[value, vector] : C)
      product *= value;
    Isochoric<dim> before;
    for (unsigned int i = 0; i < dim; ++i)
      before[i] = C[i].first * std::pow(product, -1. / dim);

    Isochoric<dim>         after = before;
    const ShearStress<dim> stress(std::sqrt(product), lame, material);
    // The exact flow needs one pass; backward Euler is more exact in several.
    const unsigned int passes = flow.yield_stress > 0. ? flow.passes : 1;
    for (unsigned int pass = 0; pass < passes; ++pass)
      {
        const double v = what_stays<dim>(after, stress, flow, dt / passes);
        if (v < 1.)
          after = relaxed<dim>(after, v);
      }

    // Written as I plus a sum, D is exactly the identity where nothing flows.
    SymmetricTensor<2, dim> D = unit_symmetric_tensor<dim>();
    for (unsigned int i = 0; i < dim; ++i)
      D += (std::sqrt(before[i] / after[i]) - 1.) *
           symmetrize(outer_product(C[i].second, C[i].second));
    return D;
  }


  template <int dim>
  SymmetricTensor<2, dim>
  given_up_by_stiffening(const Tensor<2, dim> &F_e,
                         const Lame           &before,
                         const Lame           &after,
                         const Material       &material,
                         const bool            per_grown_volume)
  {
    // The law is isotropic, so that the stress keeps its axes if the strain
    // does: only the principal stretches are sought. Newton's method begins
    // with strains that are less as the shear modulus is more, which is exact
    // for small ones, and goes by a bounded way at a time.
    constexpr double       longest = 0.3, near = 1e-9; // of the way
    constexpr unsigned int most = 50;
    const auto             C = eigenvectors(symmetrize(transpose(F_e) * F_e));
    Tensor<1, dim>         x0, step;
    for (unsigned int i = 0; i < dim; ++i)
      x0[i] = 0.5 * std::log(C[i].first);
    const Tensor<1, dim> stress =
      PrincipalStress<dim>(x0, before, material, per_grown_volume).stress;
    Tensor<1, dim> x = before.mu / std::max(before.mu, after.mu) * x0;
    unsigned int   n = 0;
    do
      {
        if (n++ == most)
          throw InputError("Material/On transition",
                           "keep stress",
                           "a stress that the cell can bear when it has "
                           "stiffened",
                           "Let Poisson's ratio change less, or keep strain.");
        const PrincipalStress<dim> now(x, after, material, per_grown_volume);
        step = invert(now.slope) * (stress - now.stress);
        if (step.norm() > longest)
          step *= longest / step.norm();
        x += step;
    } while (step.norm() > near);

    SymmetricTensor<2, dim> D;
    for (unsigned int i = 0; i < dim; ++i)
      D += std::exp(x0[i] - x[i]) *
           symmetrize(outer_product(C[i].second, C[i].second));
    return D;
  }


  MORULA_INSTANTIATE(von_mises_stress);
  MORULA_INSTANTIATE(flow_of_step);
  MORULA_INSTANTIATE(given_up_by_stiffening);
} // namespace Morula
