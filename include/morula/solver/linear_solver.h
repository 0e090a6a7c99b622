// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_linear_solver_h
#define morula_solver_linear_solver_h

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/preconditioner.h>
#include <morula/solver/solver_parameters.h>

#include <deal.II/base/timer.h>

#include <memory>

namespace Morula
{
  class DirectSolver;

  /**
   * Solves the linear systems of one step. Symmetric systems go to a conjugate
   * gradient method that reacts to negative curvature, with an incomplete
   * Cholesky factorisation that is made once a step and kept (doc/theory.md,
   * section 5); if that is not positive, with Jacobi's preconditioner.
   * Unsymmetric systems (following pressure) go to flexible GMRES, with the
   * factorisation of their symmetric part. Along the problem's null space
   * nothing is solved for: there rounding could pass for negative curvature.
   * `automatic` does the same, and turns to the direct solver for a system that
   * this cannot solve, if it is not too large for that. `direct` does
   * so at once.
   */
  class LinearSolver
  {
  public:
    using Vector = Equilibrium::Vector;
    using Matrix = Equilibrium::Matrix;

    /**
     * @param problem kept as a reference
     * @param timer   kept as a reference
     */
    LinearSolver(const SolverParameters &parameters,
                 const LinearProblem    &problem,
                 TimerOutput            &timer);

    ~LinearSolver();

    /**
     * Solves K x = b to a residual of @p tolerance |b|. On negative curvature
     * solves (K + σ |diag K|) x = b with the smallest tried σ that has none.
     * @param iterations in/out: this solve's are added (direct: its
     *                   factorisations), also when it fails
     * @param as_before  K has not changed since the last call
     * @param rank_ones  what K lacks
     * @throws StepFailed on all ranks together
     */
    void
    solve(const Matrix                &K,
          Vector                      &x,
          const Vector                &b,
          const double                 tolerance,
          unsigned int                &iterations,
          const bool                   as_before = false,
          const Equilibrium::RankOnes &rank_ones = {});

    /** No solve is looser than this. */
    double largest_tolerance = 1.;

    /** The most negative p·Kp / p·|diag K|p that the last solve met; 0: it met
     *  none. A direct solver sees no curvature: then it is minus σ. */
    double
    curvature() const
    {
      return curvature_;
    }

    /** Whether any tangent was indefinite, so that a diagonal has been raised.
     */
    bool
    has_shifted() const
    {
      return has_shifted_;
    }

  private:
    struct System; // that is being solved

    void
    solve_directly(const System &system);
    void
    solve_symmetric(const System &system);
    void
    solve_unsymmetric(const System &system);

    const bool                    is_direct;
    const bool                    automatic;
    const LinearProblem          &problem;
    TimerOutput                  &timer;
    Preconditioner                preconditioner;
    std::unique_ptr<DirectSolver> direct;
    double                        curvature_   = 0.;
    bool                          has_shifted_ = false;
    bool                          prepared     = false; // one was asked for
  };

  /** Makes linear solvers by these keys, which outlive them. Nobody reads their
   *  time: the linear solver's rows in timings.csv are those of Newton's
   * method.
   */
  MakeLinearSolver
  make_linear_solvers(const SolverParameters &parameters);
} // namespace Morula

#endif
