// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_conjugate_gradients_h
#define morula_solver_conjugate_gradients_h

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/preconditioner.h>

#include <deal.II/base/array_view.h>
#include <deal.II/base/mpi.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace Morula
{
  /** How conjugate gradients have ended. */
  enum class CgOutcome
  {
    converged,
    negative_curvature,
    indefinite_preconditioner,
    stalled // more than the iterations allowed
  };

  /** The system (K + σ |diag K|) x = b, in the space orthogonal to a null
   *  space. */
  struct ShiftedSystem
  {
    const BlockMatrix                      &K;
    const std::vector<Equilibrium::Vector> &null_space;
    double                                  shift; // σ
    /** What K lacks. */
    const Equilibrium::RankOnes &rank_ones;
  };

  namespace OneReduction
  {
    using Vector = Equilibrium::Vector;

    /** This rank's part of x·y. */
    inline double
    local_product(const Vector &x, const Vector &y)
    {
      return std::inner_product(x.begin(), x.end(), y.begin(), 0.);
    }

    /** Adds up over all ranks, in one reduction. */
    inline void
    add_up(std::vector<double> &sums, const MPI_Comm comm)
    {
      const auto view = make_array_view(sums);
      Utilities::MPI::sum(ArrayView<const double>(sums.data(), sums.size()),
                          comm,
                          view);
    }

    /** What the search direction and the step along it follow from: products
     *  of the residual r, z = P r, w = K z, and s = K p of the last p. */
    struct Products
    {
      double rz = 0., zw = 0., zs = 0.;
      double rr = 0., rw = 0., rs = 0.;
      double ww = 0., ws = 0., ss = 0.;

      static constexpr std::size_t n = 9;

      /** This rank's parts. */
      static std::vector<double>
      local(const Vector &r, const Vector &z, const Vector &w, const Vector &s)
      {
        return {local_product(r, z),
                local_product(z, w),
                local_product(z, s),
                local_product(r, r),
                local_product(r, w),
                local_product(r, s),
                local_product(w, w),
                local_product(w, s),
                local_product(s, s)};
      }

      explicit Products(const std::vector<double> &sums)
        : rz(sums[0])
        , zw(sums[1])
        , zs(sums[2])
        , rr(sums[3])
        , rw(sums[4])
        , rs(sums[5])
        , ww(sums[6])
        , ws(sums[7])
        , ss(sums[8])
      {}

      /** A bound on |r - α (w + β s)|², rounding included. */
      double
      next_residual(const double alpha, const double beta) const
      {
        constexpr double rounding =
          50. * std::numeric_limits<double>::epsilon();
        const double rKp  = rw + beta * rs;
        const double KpKp = ww + beta * (2. * ws + beta * ss);
        return rr + alpha * (alpha * KpKp - 2. * rKp) +
               rounding * (rr + alpha * alpha * KpKp);
      }
    };

    /** What lies outside the matrix: unsupported motions N, which are taken out
     *  of each vector, and the part of rank one. Without them there is nothing
     *  to add up. */
    class OutsideMatrix
    {
    public:
      OutsideMatrix(const ShiftedSystem &system, const MPI_Comm comm)
        : system(system)
        , comm(comm)
        , N(system.null_space)
      {
        for (const Equilibrium::RankOne &part : system.rank_ones)
          for (const double product : parts(part.b))
            b_N.push_back(product);
        if (!b_N.empty())
          add_up(b_N, comm);
      }

      /** Nᵀx of this rank. */
      std::vector<double>
      parts(const Vector &x) const
      {
        std::vector<double> result;
        for (const Vector &direction : N)
          result.push_back(local_product(x, direction));
        return result;
      }

      /** Takes out what @p parts says. */
      void
      remove(const double *parts, Vector &x) const
      {
        for (std::size_t k = 0; k < N.size(); ++k)
          x.add(-parts[k], N[k]);
      }

      /** Takes the motions out of @p z; b·z of each rank-one part. One
       *  reduction, if there is anything to add up. */
      std::vector<double>
      remove_from(Vector &z) const
      {
        std::vector<double> sums = parts(z);
        for (const Equilibrium::RankOne &part : system.rank_ones)
          sums.push_back(local_product(part.b, z));
        if (sums.empty())
          return {};
        add_up(sums, comm);
        remove(sums.data(), z);
        for (std::size_t k = 0; k < b_N.size(); ++k)
          sums[N.size() + k / N.size()] -= b_N[k] * sums[k % N.size()];
        return {sums.begin() + N.size(), sums.end()};
      }

    private:
      const ShiftedSystem       &system;
      const MPI_Comm             comm;
      const std::vector<Vector> &N;
      std::vector<double>        b_N; // Nᵀb of each rank-one part
    };
  } // namespace OneReduction

  /**
   * Conjugate gradients with one reduction an iteration, for several ranks:
   * that of the residual's norm, of β and of the curvature at once. The product
   * with K is taken of z = P r, and K p follows from K z as p does from z:
   * A. T. Chronopoulos and C. W. Gear: s-step iterative methods for symmetric
   * linear systems, J. Comput. Appl. Math. 25, 153-168 (1989). Here,
   * doc/theory.md (7.1), the curvature is that of z + β p itself, p·Kp = z·Kz +
   * 2β z·Kp' + β² p'·Kp', rather than what it would be of exactly conjugate
   * directions, and the norm of the next residual comes with it: so nothing is
   * computed after the last step. Unsupported motions or parts of rank one
   * take a second reduction.
   *
   * Parameters and result are those of conjugate_gradients().
   */
  template <typename Preconditioner>
  CgOutcome
  one_reduction_an_iteration(const ShiftedSystem       &system,
                             const Preconditioner      &P,
                             Equilibrium::Vector       &x,
                             const Equilibrium::Vector &b,
                             const double               tolerance,
                             const unsigned int         max_iterations,
                             unsigned int              &iterations,
                             double                    &needed)
  {
    using namespace OneReduction;
    const MPI_Comm      comm = b.get_mpi_communicator();
    const OutsideMatrix outside(system, comm);
    Vector              r(b), z(b), w(b), p(b), s(b), diagonal;
    if (system.shift > 0.)
      diagonal = diagonal_magnitude(system.K, b);
    p = 0.;
    s = 0.;
    x = 0.;
    remove_parts(r, system.null_space);
    double last_rz = 1., curvature = 0., target = 0.;
    for (unsigned int i = 0; i < max_iterations; ++i)
      {
        P.vmult(z, r);
        const std::vector<double> b_z = outside.remove_from(z);
        system.K.vmult(w, z);
        for (std::size_t k = 0; k < b_z.size(); ++k)
          w.add(system.rank_ones[k].factor * b_z[k], system.rank_ones[k].b);
        if (system.shift > 0.)
          for (unsigned int k = 0; k < w.locally_owned_size(); ++k)
            w.local_element(k) +=
              system.shift * diagonal.local_element(k) * z.local_element(k);
        auto sums = Products::local(r, z, w, s);
        for (const double part : outside.parts(w))
          sums.push_back(part);
        add_up(sums, comm);
        Products of(sums);
        outside.remove(sums.data() + Products::n, w);
        for (std::size_t k = Products::n; k < sums.size(); ++k)
          of.ww -= sums[k] * sums[k];

        if (i == 0)
          target = tolerance * std::sqrt(of.rr);
        else if (of.rr <= target * target)
          return CgOutcome::converged;
        if (!(of.rz > 0.))
          return CgOutcome::indefinite_preconditioner;
        ++iterations;
        const double beta = i == 0 ? 0. : of.rz / last_rz;
        curvature         = of.zw + beta * (2. * of.zs + beta * curvature);
        p.sadd(beta, z);
        if (!(curvature > 0.))
          {
            Vector scaled(p);
            scaled.scale(diagonal_magnitude(system.K, b));
            needed = system.shift - curvature / (p * scaled);
            return CgOutcome::negative_curvature;
          }
        s.sadd(beta, w);
        const double alpha = of.rz / curvature;
        x.add(alpha, p);
        r.add(-alpha, s);
        last_rz = of.rz;
        if (of.next_residual(alpha, beta) <= target * target)
          return CgOutcome::converged;
      }
    return CgOutcome::stalled;
  }

  /** The plain form of conjugate_gradients(). */
  template <typename Preconditioner>
  CgOutcome
  plain_conjugate_gradients(const ShiftedSystem       &system,
                            const Preconditioner      &P,
                            Equilibrium::Vector       &x,
                            const Equilibrium::Vector &b,
                            const double               tolerance,
                            const unsigned int         max_iterations,
                            unsigned int              &iterations,
                            double                    &needed)
  {
    using Vector = Equilibrium::Vector;
    Vector r(b), z(b), p(b), Kp(b), shifted(b), diagonal;
    // Hardly any system is shifted, and the search for the entries takes time.
    if (system.shift > 0.)
      diagonal = diagonal_magnitude(system.K, b);
    x = 0.;
    remove_parts(r, system.null_space);
    P.vmult(z, r);
    remove_parts(z, system.null_space);
    p                   = z;
    double       rz     = r * z;
    const double target = tolerance * r.l2_norm();
    for (unsigned int i = 0; i < max_iterations; ++i)
      {
        if (!(rz > 0.))
          return CgOutcome::indefinite_preconditioner;
        system.K.vmult(Kp, p);
        add_rank_ones(Kp, system.rank_ones, p);
        if (system.shift > 0.)
          {
            shifted = p;
            shifted.scale(diagonal);
            Kp.add(system.shift, shifted);
          }
        remove_parts(Kp, system.null_space);
        ++iterations;
        const double curvature = p * Kp;
        if (!(curvature > 0.))
          {
            shifted = p;
            shifted.scale(diagonal_magnitude(system.K, b));
            needed = system.shift - curvature / (p * shifted);
            return CgOutcome::negative_curvature;
          }
        const double alpha = rz / curvature;
        x.add(alpha, p);
        r.add(-alpha, Kp);
        if (r.l2_norm() <= target)
          return CgOutcome::converged;
        P.vmult(z, r);
        remove_parts(z, system.null_space);
        const double rz_new = r * z;
        p.sadd(rz_new / rz, z);
        rz = rz_new;
      }
    return CgOutcome::stalled;
  }

  /**
   * Preconditioned conjugate gradients that stop when they meet negative
   * curvature. deal.II's SolverCG and Trilinos' AztecOO and Belos do not look
   * at the curvature: they iterate on for thousands of steps on an indefinite
   * tangent, or return one along which the energy rises.
   *
   * On one rank, where a reduction costs nothing, this is the plain form: the
   * curvature is that of the product with p itself.
   * @param tolerance of the residual, relative to |b|
   * @param iterations in/out: this solve's are added
   * @param needed out: on negative curvature the σ with which that direction
   *        would have had none
   */
  template <typename Preconditioner>
  CgOutcome
  conjugate_gradients(const ShiftedSystem       &system,
                      const Preconditioner      &P,
                      Equilibrium::Vector       &x,
                      const Equilibrium::Vector &b,
                      const double               tolerance,
                      const unsigned int         max_iterations,
                      unsigned int              &iterations,
                      double                    &needed)
  {
    const bool alone =
      Utilities::MPI::n_mpi_processes(b.get_mpi_communicator()) == 1;
    return (alone ? plain_conjugate_gradients<Preconditioner> :
                    one_reduction_an_iteration<Preconditioner>)(system,
                                                                P,
                                                                x,
                                                                b,
                                                                tolerance,
                                                                max_iterations,
                                                                iterations,
                                                                needed);
  }
} // namespace Morula

#endif
