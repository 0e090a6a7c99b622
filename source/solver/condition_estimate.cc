// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/condition_estimate.h>

#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/tridiagonal_matrix.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

namespace Morula
{
  namespace
  {
    using Vector = Equilibrium::Vector;
    using Matrix = Equilibrium::Matrix;

    /** Far beyond what solves a system: the smallest eigenvalue settles late,
     *  and SolverCG keeps the last coefficient to itself. */
    constexpr double       reduction               = 1e-20;
    constexpr unsigned int max_estimate_iterations = 5000; // and 100 + 10 n

    /**
     * P D^(-1/2) (K + K^T)/2 D^(-1/2) P, where P removes the scaled null space.
     * There it is a multiple of the identity, the mean of the other
     * eigenvalues: were it zero, rounding would make conjugate gradients
     * diverge along it.
     */
    class ScaledTangent
    {
    public:
      ScaledTangent(const LinearProblem &problem,
                    const Matrix        &K,
                    const Vector        &layout)
        : K(K)
        , scale(K.diagonal(layout))
        , x(layout)
        , part(layout)
      {
        // A diagonal without stiffness is left as it is; the estimate then
        // shows an eigenvalue of 0.
        for (double &entry : scale)
          entry = entry != 0. ? 1. / std::sqrt(std::abs(entry)) : 1.;
        // What the tangent does not feel are motions n; of the scaled tangent
        // they are D^(1/2) n. They are made orthonormal, as remove_parts() asks
        // for it.
        for (const Vector &direction : problem.null_space)
          {
            // D^(1/2) n, orthonormal
            Vector scaled(direction);
            for (unsigned int k = 0; k < scaled.locally_owned_size(); ++k)
              scaled.local_element(k) /= scale.local_element(k);
            remove_parts(scaled, null_space);
            scaled /= scaled.l2_norm();
            null_space.push_back(scaled);
          }
        // The trace of a matrix with a unit diagonal is n; the null space,
        // where K is zero, adds nothing to it.
        const double n = layout.size();
        mean           = n / std::max(1., n - null_space.size());
      }

      void
      vmult(Vector &y, const Vector &in) const
      {
        // Symmetric by construction: P S K S P with S = D^(-1/2). The last
        // lines add the mean eigenvalue along the null space.
        x = in;
        remove_parts(x, null_space);
        x.scale(scale);
        K.vmult(y, x);
        y.scale(scale);
        remove_parts(y, null_space);
        part = in;
        remove_parts(part, null_space);
        part.sadd(-1., 1., in);
        y.add(mean, part);
      }

    private:
      const Matrix       &K;
      Vector              scale; // D^(-1/2)
      std::vector<Vector> null_space;
      double              mean;
      mutable Vector      x, part;
    };

    /**
     * Lanczos' tridiagonal matrix from the coefficients of conjugate gradients.
     * SolverCG offers its eigenvalues, too, but without their signs.
     */
    class LanczosMatrix
    {
    public:
      void
      add(const double alpha, const double beta)
      {
        // The relation of the coefficients of conjugate gradients to Lanczos'
        // matrix: diagonal 1/alpha_i + beta_(i-1)/alpha_(i-1), off-diagonal
        // sqrt(beta_i)/alpha_i.
        const double next = 1. / alpha + carried;
        const double off  = std::sqrt(beta) / alpha;
        if (!std::isfinite(next) || !std::isfinite(off))
          return; // behind a breakdown
        carried = beta / alpha;
        diagonal.push_back(next);
        off_diagonal.push_back(off);
      }

      /** The smallest and the largest eigenvalue. */
      std::pair<double, double>
      extremes() const
      {
        const std::size_t n = diagonal.size();
        if (n == 0)
          return {0., 0.};
        TridiagonalMatrix<double> T(n, true);
        for (std::size_t i = 0; i < n; ++i)
          {
            T(i, i) = diagonal[i];
            if (i + 1 < n)
              T(i, i + 1) = off_diagonal[i];
          }
        T.compute_eigenvalues();
        return {T.eigenvalue(0), T.eigenvalue(n - 1)};
      }

    private:
      std::vector<double> diagonal, off_diagonal;
      double              carried = 0.;
    };

    /** A random vector has a part in every eigenvector. */
    Vector
    random_vector(const Vector &layout)
    {
      Vector     result(layout);
      const auto owned = result.locally_owned_elements();
      // Each rank's seed follows from its first row, so a run finds the same
      // estimate again.
      std::mt19937_64 generator(
        owned.n_elements() > 0 ? 1 + owned.nth_index_in_set(0) : 0);
      std::normal_distribution<double> normal;
      for (double &entry : result)
        entry = normal(generator);
      return result;
    }
  } // namespace

  ConditionEstimate
  estimate_condition(Equilibrium         &problem,
                     const LinearProblem &linear_problem,
                     const Vector        &rest)
  {
    // The tangent is that of Newton's first iteration, assembled once more.
    // SolverCG runs on its scaled form until the residual has fallen far beyond
    // what a solution needs, or until the iterations run out. Its coefficients
    // make Lanczos' matrix, whose extreme eigenvalues tend to those of the
    // tangent, doc/theory.md (5.5). A breakdown tells of a direction without
    // stiffness.
    const Matrix       &K    = problem.tangent(rest, GrowthAt::previous);
    const Matrix        part = K.is_symmetric() ? Matrix() : K.symmetric_part();
    const ScaledTangent A(linear_problem, K.is_symmetric() ? K : part, rest);
    Vector              x(rest), b = random_vector(rest);

    // Only the coefficients of the iteration count: it does not matter whether
    // it converges.
    LanczosMatrix    lanczos;
    bool             breakdown = false;
    ReductionControl control(std::min<unsigned int>(max_estimate_iterations,
                                                    100 + 10 * rest.size()),
                             0.,
                             reduction,
                             false,
                             false);
    SolverCG<Vector> solver(control);
    solver.connect_coefficients_slot(
      [&](const double alpha, const double beta) { lanczos.add(alpha, beta); });
    try
      {
        solver.solve(A, x, b, PreconditionIdentity());
      }
    catch (const SolverControl::NoConvergence &)
      {
        breakdown = !std::isfinite(control.last_value());
      }
    catch (const StandardExceptions::ExcDivideByZero &)
      {
        // deal.II tests for this in a debug build only.
        breakdown = true; // in Debug
      }

    ConditionEstimate estimate;
    estimate.unknowns                             = rest.size();
    std::tie(estimate.smallest, estimate.largest) = lanczos.extremes();
    // The iteration has met a direction without any stiffness.
    if (breakdown)
      estimate.smallest = std::min(estimate.smallest, 0.);
    return estimate;
  }
} // namespace Morula
