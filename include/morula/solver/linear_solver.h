// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_linear_solver_h
#define morula_solver_linear_solver_h

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/overlapping_cholesky.h>
#include <morula/solver/solver_parameters.h>

#include <deal.II/base/timer.h>
#include <deal.II/lac/trilinos_solver.h>

#include <memory>

namespace Morula
{
  /**
   * Solves the linear systems of one step. Symmetric systems go to a conjugate
   * gradient method that reacts to negative curvature, with an incomplete
   * Cholesky factorisation that is made once a step and kept
   * (doc/theory.md, section 5); where that is not positive, Jacobi.
   * Unsymmetric systems (following pressure) go to GMRES, with the
   * factorisation of their symmetric part. Along the problem's null space
   * nothing is solved for: there rounding could pass for negative curvature.
   * `automatic` does the same, and turns to the direct solver for a system that
   * this cannot solve.
   * `direct` uses MUMPS, or KLU where Trilinos lacks it.
   */
  class LinearSolver
  {
  public:
    using Vector = Equilibrium::Vector;
    using Matrix = Equilibrium::Matrix;

    /**
     * @param problem kept as a reference
     */
    LinearSolver(const SolverParameters &parameters,
                 const Equilibrium      &problem,
                 TimerOutput            &timer);

    ~LinearSolver();

    /**
     * Solves K x = b to a residual of @p tolerance |b|. On negative curvature
     * solves (K + σ |diag K|) x = b with the smallest tried σ that has none.
     * @param iterations in/out: this solve's are added (direct: its
     *                   factorisations), also when it fails
     * @throws StepFailed on all ranks together
     */
    void
    solve(const Matrix &K,
          Vector       &x,
          const Vector &b,
          const double  tolerance,
          unsigned int &iterations);

    /** The largest σ that was needed; 0 where no tangent was indefinite. */
    double
    largest_shift() const;

  private:
    void
    solve_symmetric(const Matrix &K,
                    Vector       &x,
                    const Vector &b,
                    const double  tolerance,
                    unsigned int &iterations);

    void
    solve_unsymmetric(const Matrix &K,
                      Vector       &x,
                      const Vector &b,
                      const double  tolerance,
                      unsigned int &iterations);

    void
    solve_direct(const Matrix &K,
                 Vector       &x,
                 const Vector &b,
                 unsigned int &iterations);

    /**
     * Solves A x = b in the space orthogonal to the problem's null space,
     * where A, factored by @p solver, is nearly singular. The motions that A
     * gives no stiffness are those of the deformed body, and not quite
     * orthogonal to that space: projecting A⁻¹b onto it would leave a large
     * rotation. Solves A x + N μ = b, Nᵀx = 0 with the null space N instead.
     */
    void
    solve_bordered(const Matrix                   &A,
                   TrilinosWrappers::SolverDirect &solver,
                   Vector                         &x,
                   const Vector                   &b) const;

    void
    make_preconditioner(const Matrix &K);

    /** Removes the part in the problem's null space. */
    void
    project(Vector &x) const;

    const bool         direct;
    const bool         automatic;
    const Equilibrium &problem;
    const bool         symmetric;
    TimerOutput       &timer;
    Matrix symmetric_part; // of an unsymmetric tangent; the preconditioner's
    std::unique_ptr<OverlappingCholesky> preconditioner;
    std::size_t                          n_attempts     = 0; // to make one
    double                               largest_shift_ = 0.;
    bool prepared = false; // a preconditioner was made; none now: Jacobi
  };
} // namespace Morula

#endif
