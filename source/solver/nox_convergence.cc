// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/nox_convergence.h>
#include <morula/solver/nox_group.h>

#include <NOX_Solver_Generic.H>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** Iterations without progress after which the method is at its end. Where
     *  a soft motion follows a stiff curved path, the residual rises and falls
     *  for some iterations, and its lowest value still falls within ten. */
    constexpr int patience = 20;

    /** A residual that is lower by less than this part is no progress: without
     *  an energy it can creep down for ever towards a state that is none. */
    constexpr double least_fall = 0.01;

    /** An iteration with a tangent of its own ends far below the bound of
     *  displacements, one with a kept tangent anywhere below: it has to reach
     *  this part of the bound. */
    constexpr double part_of_kept = 0.1;

    /** The largest change of a coefficient by the last iteration, µm. */
    double
    last_motion(const NOX::Solver::Generic &solver)
    {
      const auto change = solver.getSolutionGroup().getX().clone();
      change->update(-1., solver.getPreviousSolutionGroup().getX(), 1.);
      return change->norm(NOX::Abstract::Vector::MaxNorm);
    }
  } // namespace


  ConvergenceTest::ConvergenceTest(const Bounds   &bounds,
                                   const Tangents &tangents,
                                   const bool      has_energy,
                                   NewtonReport   &report)
    : bounds(bounds)
    , tangents(tangents)
    , has_energy(has_energy)
    , report(report)
  {}


  NOX::StatusTest::StatusType
  ConvergenceTest::checkStatus(const NOX::Solver::Generic &solver,
                               NOX::StatusTest::CheckType)
  {
    // The conditions of doc/theory.md (5.3), the cheapest one first. A state
    // within rounding has converged, whatever is left to move: no iteration can
    // do better. At the start nothing has moved yet, so there is no motion to
    // judge. Then come the signs of failure. The norm is the same on all ranks,
    // and so is the outcome.
    look(solver);
    const double norm      = last_norm;
    const int    iteration = solver.getNumIterations();
    status                 = NOX::StatusTest::Failed;
    if (norm <= bounds.rounding ||
        (norm <= bounds.residual &&
         (iteration == 0 ||
          left_over(solver) <=
            (tangents.kept() ? part_of_kept : 1.) * bounds.displacement)))
      status = NOX::StatusTest::Converged;
    else if (!std::isfinite(norm))
      reason = "the unbalanced forces are infinite";
    else if (iteration >= static_cast<int>(bounds.iterations))
      reason =
        "Solver/Newton iterations = " + std::to_string(bounds.iterations) +
        " were not enough";
    else if (iteration - progress_at >= patience)
      reason =
        std::to_string(patience) +
        " iterations have brought no lower energy and no smaller residual";
    else
      status = NOX::StatusTest::Unconverged;
    return status;
  }


  void
  ConvergenceTest::look(const NOX::Solver::Generic &solver)
  {
    const auto &group =
      dynamic_cast<const NoxGroup &>(solver.getSolutionGroup());
    const double norm      = group.getNormF();
    const double energy    = group.evaluation().energy;
    const int    iteration = solver.getNumIterations();
    // Here is noted what the test above asks of this iteration, whether it was
    // progress, and what the report tells of it. The lowest residual stays
    // until it is beaten by a hundredth, so that many small falls add up to
    // progress.
    const bool falls = norm < (1. - least_fall) * lowest_norm;
    if (falls || (has_energy && energy < lowest_energy))
      progress_at = iteration;
    if (falls)
      lowest_norm = norm;
    lowest_energy = std::min(lowest_energy, energy);
    has_risen     = has_risen || norm > last_norm;
    last_norm     = norm;
    if (!report.wants_trace)
      return;
    NewtonIteration state;
    state.iteration  = iteration;
    state.evaluation = group.evaluation();
    state.residual   = norm;
    state.place      = report.place;
    if (iteration > 0)
      {
        state.part      = group.part_taken();
        state.motion    = last_motion(solver);
        state.curvature = group.curvature();
      }
    report.trace.push_back(state);
  }


  const std::string &
  ConvergenceTest::reason_of_failure() const
  {
    return reason;
  }


  NOX::StatusTest::StatusType
  ConvergenceTest::getStatus() const
  {
    return status;
  }


  std::ostream &
  ConvergenceTest::print(std::ostream &stream, int) const
  {
    return stream << "|R| <= " << bounds.residual << '\n';
  }


  double
  ConvergenceTest::left_over(const NOX::Solver::Generic &solver) const
  {
    // The next change is about the last one times the rate of convergence,
    // doc/theory.md (5.3). Once the residual has risen that rate says nothing.
    const double size = last_motion(solver);
    if (!(size > 0.))
      return std::numeric_limits<double>::infinity();
    return has_risen ? size :
                       size * solver.getSolutionGroup().getNormF() /
                         solver.getPreviousSolutionGroup().getNormF();
  }
} // namespace Morula
