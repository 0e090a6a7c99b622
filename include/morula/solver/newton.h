// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_newton_h
#define morula_solver_newton_h

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/solver_parameters.h>

#include <deal.II/base/timer.h>

namespace Morula
{
  /** Work done, and where it ended. Counts add up over several solves. */
  struct NewtonReport
  {
    unsigned int newton_iterations = 0;
    unsigned int linear_iterations = 0;
    /** |R| relative to the first residual of the last solve. */
    double residual = 0.;
  };

  /**
   * Finds the equilibrium increment u of a step with Newton's method (Trilinos
   * NOX; doc/theory.md, section 5):
   * - the first tangent is taken at the growth of the step's beginning; a
   *   costly one is kept while the residual falls fivefold;
   * - symmetric tangents: backtracking on the energy with Armijo's rule, which
   *   rejects inversion (infinite energy) and tolerates rounding; others:
   *   backtracking on |R|;
   * - linear systems are solved to Eisenstat and Walker's forcing terms;
   * - converged where |R| <= max(tol max(|R_0|, small force), rounding), and
   *   what is left to move, estimated from the last iteration, is below tol
   *   times the typical length: doc/theory.md (5.3).
   *
   * @param linear_problem what is known of the problem's tangents
   * @param scales what small forces and lengths are compared with
   * @param u      in: where to start from; out: the increment, or where the
   *               method has failed
   * @param report in/out: this solve's work is added, also when it fails
   * @return energy and extremes at u
   * @throws StepFailed on all ranks together
   */
  Equilibrium::Evaluation
  solve(Equilibrium            &problem,
        const LinearProblem    &linear_problem,
        const NewtonScales     &scales,
        const SolverParameters &parameters,
        TimerOutput            &timer,
        Equilibrium::Vector    &u,
        NewtonReport           &report);
} // namespace Morula

#endif
