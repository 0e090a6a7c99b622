// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/equilibrium.h>
#include <morula/solver/preconditioner.h>
#include <morula/solver/proximal_path.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** c of the first part: a fold's curvature is of this size, so that the
     *  first part is stable and still long. */
    constexpr double first_proximity = 1e-3;
    /** Below it a part can hardly be told from the equilibrium itself. */
    constexpr double least_proximity = 1e-6;
    /** Above it a part hardly moves: the path is stuck. */
    constexpr double most_proximity = 10.;
    /** A part that needs more iterations is too long. */
    constexpr unsigned int iterations_of_part = 20;
    /** One that needs as few or fewer may be followed by a longer one, */
    constexpr unsigned int few_iterations = 10;
    /** unless one of the last so many has failed: the longer one would fail,
     *  too, and failures cost most. */
    constexpr unsigned int parts_after_failure = 4;
    /** Iterations of a path in those of Solver/Newton iterations; one of more
     *  does not come to an end. */
    constexpr unsigned int budget = 2;
  } // namespace


  // Each part starts where the last one has ended, and is as long as Newton's
  // method can do it at ease: c falls after a part of few iterations, rises
  // where one fails, which is then tried again, and stays for some parts after
  // that. A part that moves further than a grid spacing has failed, too: it may
  // have left the way on which the tissue glides, for one that rounding
  // decides. Once c is so small that it no longer counts, the equilibrium
  // itself, c = 0, is solved for; where that fails, parts go on from there. The
  // equations are those of doc/theory.md (5.7). The parts need not be solved
  // more accurately than the step itself.
  Equilibrium::Evaluation
  follow_proximal_path(Equilibrium            &problem,
                       const LinearProblem    &linear_problem,
                       const NewtonScales     &scales,
                       const SolverParameters &parameters,
                       TimerOutput            &timer,
                       Equilibrium::Vector    &u,
                       NewtonReport           &report)
  {
    ++report.proximal_paths;
    Equilibrium::Vector R(u);
    problem.residual(u, R);
    // The residual at the start is the force that the path has to work off: a
    // part counts as solved relative to it.
    remove_parts(R, linear_problem.null_space);
    NewtonScales of_parts    = scales;
    of_parts.small_force     = std::max(scales.small_force, R.l2_norm());
    SolverParameters limited = parameters;
    limited.newton_iterations =
      std::min<unsigned int>(iterations_of_part, parameters.newton_iterations);

    ProximalEquilibrium nearby(problem);
    Equilibrium::Vector centre(u);
    double              c    = first_proximity;
    unsigned int        wait = 0; // parts until c may fall again
    const unsigned int  most =
      report.newton_iterations + budget * parameters.newton_iterations;
    std::string reason = "it does not come to an end";
    while (report.newton_iterations <= most && c <= most_proximity)
      try
        {
          const unsigned int before = report.newton_iterations;
          nearby.set(centre, c);
          report.place.proximity = c;
          const Equilibrium::Evaluation evaluation =
            solve(nearby, linear_problem, of_parts, limited, timer, u, report);
          Equilibrium::Vector moved(u);
          moved -= centre;
          if (moved.linfty_norm() > scales.length)
            throw StepFailed("the tissue moves too far at once");
          centre                 = u;
          report.place.proximity = 0.;
          // One part has been solved, so all later tangents are at the new
          // growth.
          nearby.use_growth_at_end();
          if (c == 0.)
            return evaluation;
          if (wait > 0)
            --wait;
          else if (report.newton_iterations - before <= few_iterations)
            c *= 0.25;
          if (c < least_proximity)
            c = 0.;
        }
      catch (const StepFailed &failure)
        {
          reason                 = failure.what();
          report.place.proximity = 0.;
          // A failed end of the path has c = 0, from which c cannot rise
          // fourfold.
          c    = c == 0. ? 4. * least_proximity : 4. * c;
          wait = parts_after_failure;
          u    = centre;
        }
    throw StepFailed(reason + "; this was on a proximal path");
  }


  namespace
  {
    /** A volume that is kept takes two to four turns, a held traction as many:
     *  what needs more does not contract. */
    constexpr unsigned int most_turns = 20;
  } // namespace


  Equilibrium::Evaluation
  balance_in_turns(Equilibrium                          &problem,
                   const std::vector<TurnParticipant *> &participants,
                   const SolveTurn                      &solve,
                   const Equilibrium::Vector            &u,
                   NewtonReport                         &report)
  {
    // Each turn finds an equilibrium with what the participants hold fixed, and
    // then has all of them renew it, doc/theory.md (5.6). All are asked, also
    // after one has said that it needs another turn: their quantities belong to
    // the same u. If all of them allow that, they are renewed on the way, too.
    // After the first turn the tissue has the new growth, and so have all
    // further tangents.
    std::string   unfinished;
    const Renewal renew = [&](const Equilibrium::Vector &u) {
      unfinished.clear();
      for (TurnParticipant *const participant : participants)
        if (participant->renew(u) && unfinished.empty())
          unfinished = participant->unfinished();
      return !unfinished.empty();
    };
    const auto early = [&]() {
      return !participants.empty() &&
             std::all_of(participants.begin(),
                         participants.end(),
                         [](const auto *const p) { return p->renews_early(); });
    };
    const Renewal renew_early = [&](const Equilibrium::Vector &u) {
      return early() && renew(u);
    };
    for (report.place.turn = 1;; ++report.place.turn)
      {
        ++report.turns;
        const Equilibrium::Evaluation evaluation =
          solve(early() ? renew_early : Renewal());
        if (!renew(u))
          return evaluation;
        if (report.place.turn >= most_turns)
          throw StepFailed(unfinished);
        problem.use_growth_at_end();
      }
  }
} // namespace Morula
