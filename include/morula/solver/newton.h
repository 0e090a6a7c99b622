// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_newton_h
#define morula_solver_newton_h

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/solver_parameters.h>

#include <deal.II/base/timer.h>

#include <functional>
#include <vector>

namespace Morula
{
  /** Where in a step a solve stands. */
  struct NewtonPlace
  {
    unsigned int attempt   = 1;
    unsigned int turn      = 1;  // of the attempt
    double       proximity = 0.; // c of the proximal path (5.7); 0 outside
  };

  /** A state that Newton's method has accepted. */
  struct NewtonIteration
  {
    NewtonPlace  place;
    unsigned int iteration = 0; // 0: where the solve started
    /** Energy; the extremes are those of this rank's points. */
    Equilibrium::Evaluation evaluation;
    double                  residual = 0.; // |R|, kPa µm^(dim-1)
    /** ω, the part of the direction that the line search has taken. */
    double part = 0.;
    /** The largest change of a coefficient by this iteration, µm. */
    double motion = 0.;
    /** p·Kp / p·|diag K|p along the direction p of most negative curvature that
     *  the linear solver met; 0: it met none. */
    double curvature = 0.;
  };

  /** Work done, and where it ended. Counts add up over several solves. */
  struct NewtonReport
  {
    unsigned int newton_iterations = 0;
    unsigned int linear_iterations = 0;
    unsigned int turns             = 0; // equilibria with frozen quantities
    unsigned int proximal_paths    = 0; // that were needed
    /** |R| of the last solve relative to first_residual. */
    double residual = 0.;
    /** |R| where the first solve has begun since this was 0, kPa µm^(dim-1). */
    double first_residual = 0.;
    /** The most negative curvature since this was 0, as in the trace. */
    double curvature = 0.;
    /** Where an attempt has failed, with the extremes of all ranks. */
    Equilibrium::Evaluation failed_at;

    /** Whether the last solve has ended next to balance, because along a motion
     *  that hardly anything resists Newton's method led away from there. */
    bool ends_at_leap = false;

    /** The place of the present solve. */
    NewtonPlace place;

    /** Is called before each iteration, and ends the solve by throwing. */
    std::function<void()> before_iteration;

    /** Whether states are to be noted down, and those of all solves. */
    bool                         wants_trace = false;
    std::vector<NewtonIteration> trace;
  };

  /** Renews what an equilibrium holds fixed, as TurnParticipant::renew(). */
  using Renewal = std::function<bool(const Equilibrium::Vector &u)>;

  /** What is done on the way to an equilibrium, if it is not empty. */
  struct OnTheWay
  {
    /** Throws StepFailed on all ranks where an indefinite tangent has led to a
     *  state from which the problem's solution cannot be found. Collective. */
    std::function<void(const Equilibrium::Vector &u)> check;
    /** Called where the first iteration has gone well: turns of their own,
     *  which begin with the last tangent. */
    Renewal renew;
  };

  /**
   * Finds the equilibrium increment u of a step with Newton's method (Trilinos
   * NOX; doc/theory.md, section 5):
   * - the first tangent is taken at the growth of the step's beginning; a
   *   costly one is kept while the residual falls fivefold;
   * - symmetric tangents: backtracking on the energy with Armijo's rule against
   *   the largest of the last ten energies, which rejects inversion (infinite
   *   energy) and tolerates rounding; others: backtracking on |R|;
   * - linear systems are solved to Eisenstat and Walker's forcing terms;
   * - converged where |R| <= max(tol max(|R_0|, small force), rounding), and
   *   what is left to move, estimated from the last iteration, is below tol
   *   times the typical length: doc/theory.md (5.3);
   * - it goes on while it gets on: it fails once twenty iterations have brought
   *   neither a new lowest energy nor a new lowest residual, at Solver/Newton
   *   iterations, or next to balance before a leap along a motion that hardly
   *   anything resists, where u stays.
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
        NewtonReport           &report,
        const OnTheWay         &on_the_way = {});

  /** Solves with what is held fixed; may renew it early. */
  using SolveTurn =
    std::function<Equilibrium::Evaluation(const Renewal &early)>;

  /**
   * The equilibrium of a step in turns: solves, asks every participant to renew
   * what it holds fixed, and solves again from there, until none needs another
   * turn. Collective.
   * @param solve  finds the displacement @p u at which the problem is balanced
   * @param report in/out: counts the turns
   * @throws StepFailed after twenty turns
   */
  Equilibrium::Evaluation
  balance_in_turns(Equilibrium                          &problem,
                   const std::vector<TurnParticipant *> &participants,
                   const SolveTurn                      &solve,
                   const Equilibrium::Vector            &u,
                   NewtonReport                         &report);
} // namespace Morula

#endif
