// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_newton_h
#define morula_solver_newton_h

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/solver_parameters.h>

#include <deal.II/base/timer.h>

#include <optional>

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
   * NOX), starting from u = 0 or @p start (doc/theory.md, section 5):
   * - the first tangent is taken at the growth of the step's beginning;
   * - conservative problems: backtracking on the energy with Armijo's rule,
   *   which rejects inversion (infinite energy) and tolerates rounding; others:
   *   backtracking on |R|;
   * - linear systems are solved to Eisenstat and Walker's forcing terms;
   * - converged where |R| <= max(tol max(|R_0|, small force), rounding), and
   *   what is left to move, estimated from the last iteration, is below tol
   *   times the typical length: doc/theory.md (5.3).
   *
   * @param u      out: the increment; initialised here
   * @param report in/out: this solve's work is added, also when it fails
   * @param start  where to start from, if not from rest
   * @throws StepFailed on all ranks together
   */
  void
  solve(Equilibrium                              &problem,
        const SolverParameters                   &parameters,
        TimerOutput                              &timer,
        Equilibrium::Vector                      &u,
        NewtonReport                             &report,
        const std::optional<Equilibrium::Vector> &start = {});
} // namespace Morula

#endif
