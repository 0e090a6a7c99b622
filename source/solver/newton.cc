// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/linear_solver.h>
#include <morula/solver/newton.h>
#include <morula/solver/nox_group.h>

#include <NOX_LineSearch_Generic.H>
#include <NOX_LineSearch_UserDefinedFactory.H>
#include <NOX_Solver_Factory.H>
#include <NOX_Solver_Generic.H>
#include <NOX_StatusTest_Generic.H>
#include <NOX_Utils.H>
#include <Teuchos_ParameterList.hpp>
#include <Teuchos_oblackholestream.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

namespace Morula
{
  namespace
  {
    /** Iterations without progress after which the method is at its end. Where
     *  a soft motion follows a stiff path, the residual falls within ten. */
    constexpr int patience = 20;

    /** A residual that is lower by less than this part is no progress: without
     *  an energy it can creep down for ever towards a state that is none. */
    constexpr double least_fall = 0.01;

    /** An iteration with a tangent of its own ends far below the bound of
     *  displacements, one with a kept tangent anywhere below: it has to reach
     *  this part of the bound. */
    constexpr double part_of_kept = 0.1;

    /** What is held fixed is renewed as soon as an iteration has brought the
     *  residual down to this part and moved nothing by more than a grid
     *  spacing: the renewal then changes more than what is left of it. Only a
     *  turn's first iterations may, whose linear solves are exact: what is
     *  renewed after them must not feel ranks. */
    constexpr double       early = 0.1, exact = 1e-4;
    constexpr int          early_iterations = 3;
    constexpr unsigned int last_early_turn  = 10; // then it is no help

    /** The largest change of a coefficient by the last iteration, µm. */
    double
    last_motion(const NOX::Solver::Generic &solver)
    {
      const auto change = solver.getSolutionGroup().getX().clone();
      change->update(-1., solver.getPreviousSolutionGroup().getX(), 1.);
      return change->norm(NOX::Abstract::Vector::MaxNorm);
    }


    /**
     * Converged where both the unbalanced forces and what they may still move
     * are below their bounds, doc/theory.md (5.3). Failed where Newton's method
     * no longer gets on: its last iterations have brought neither a new lowest
     * energy nor a new lowest residual. Notes the states down if the report
     * wants them.
     */
    class ConvergenceTest : public NOX::StatusTest::Generic
    {
    public:
      /** Where the method ends. */
      struct Bounds
      {
        double       residual;     // kPa µm^(dim-1)
        double       rounding;     // of the residual: below it nothing is asked
        double       displacement; // µm
        unsigned int iterations;
      };

      /** @param has_energy whether a lower energy counts as progress
       *  @param report     kept as a reference, as are the tangents */
      ConvergenceTest(const Bounds   &bounds,
                      const Tangents &tangents,
                      const bool      has_energy,
                      const OnTheWay &on_the_way,
                      NewtonReport   &report)
        : bounds(bounds)
        , tangents(tangents)
        , has_energy(has_energy)
        , on_the_way(on_the_way)
        , report(report)
      {}

      NOX::StatusTest::StatusType
      checkStatus(const NOX::Solver::Generic &solver,
                  NOX::StatusTest::CheckType) override
      {
        // The conditions of doc/theory.md (5.3), the cheapest one first. A
        // state within rounding has converged, whatever is left to move: no
        // iteration can do better. At the start there is no motion to judge.
        if (report.before_iteration)
          report.before_iteration();
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

      /** Why it has failed; also where the line search has. */
      const std::string &
      reason_of_failure() const
      {
        return reason;
      }

      NOX::StatusTest::StatusType
      getStatus() const override
      {
        return status;
      }

      std::ostream &
      print(std::ostream &stream, int) const override
      {
        return stream << "|R| <= " << bounds.residual << '\n';
      }

    private:
      /** The last change of the solution times the ratio by which the residual
       *  became smaller, in the maximum norm, µm: doc/theory.md (5.3). Once the
       *  residual has grown in an iteration, it says nothing of the motion that
       *  is left: then the change itself. Infinite where the iteration has
       *  changed nothing. */
      double
      left_over(const NOX::Solver::Generic &solver) const
      {
        const double size = last_motion(solver);
        if (!(size > 0.))
          return std::numeric_limits<double>::infinity();
        return has_risen ? size :
                           size * solver.getSolutionGroup().getNormF() /
                             solver.getPreviousSolutionGroup().getNormF();
      }

      /** Takes the present state into account: its energy and residual. */
      void
      look(const NOX::Solver::Generic &solver)
      {
        const auto &group =
          dynamic_cast<const NoxGroup &>(solver.getSolutionGroup());
        const double norm      = group.getNormF();
        const double energy    = group.evaluation().energy;
        const int    iteration = solver.getNumIterations();
        const bool   falls     = norm < (1. - least_fall) * lowest_norm;
        if (falls || (has_energy && energy < lowest_energy))
          progress_at = iteration;
        if (falls)
          lowest_norm = norm;
        lowest_energy = std::min(lowest_energy, energy);
        has_risen     = has_risen || norm > last_norm;
        last_norm     = norm;
        if (iteration > 0 && on_the_way.check && group.curvature() < 0.)
          on_the_way.check(values_of(group.getX()));
        if (!report.wants_trace)
          return;
        NewtonIteration state{report.place,
                              unsigned(iteration),
                              group.evaluation(),
                              norm};
        if (iteration > 0)
          {
            state.part      = group.part_taken();
            state.motion    = last_motion(solver);
            state.curvature = group.curvature();
          }
        report.trace.push_back(state);
      }

      const Bounds    bounds;
      const Tangents &tangents;
      const bool      has_energy;
      const OnTheWay &on_the_way;
      NewtonReport   &report;
      double          last_norm   = std::numeric_limits<double>::infinity();
      double          lowest_norm = // that counted as progress, N
        std::numeric_limits<double>::infinity();
      double      lowest_energy = std::numeric_limits<double>::infinity();
      int         progress_at   = 0; // the iteration that brought the lowest
      bool        has_risen     = false; // the residual, in any iteration
      std::string reason        = "no part of Newton's step has a lower energy";
      NOX::StatusTest::StatusType status = NOX::StatusTest::Unevaluated;
    };


    /** The number of energies of which the largest counts. */
    constexpr unsigned int memory = 10;


    /**
     * Backtracking on the energy with Armijo's rule and slack for rounding,
     * doc/theory.md (5.2); for problems without energy, on |R|. Inversion
     * counts as infinite energy. The direction of a kept tangent is taken as a
     * whole, if it makes |R| smaller as well, or not at all: then the next
     * iteration has a tangent of its own.
     *
     * The energy may rise for some iterations: it is compared with the largest
     * of the last ten states of this solve (Grippo, Lampariello and Lucidi,
     * 1986). A soft motion, such as a fold's, that follows a curved stiff path
     * would otherwise be cut to a small part of itself in every other
     * iteration.
     */
    class EnergyLineSearch : public NOX::LineSearch::Generic
    {
    public:
      EnergyLineSearch(const Equilibrium &problem, const bool has_energy)
        : problem(problem)
        , has_energy(has_energy)
      {}

      bool
      compute(NOX::Abstract::Group        &group,
              double                      &step,
              const NOX::Abstract::Vector &direction,
              const NOX::Solver::Generic  &solver) override
      {
        // The whole direction is tried, then halves of it. A part is accepted
        // if the energy there is low enough, doc/theory.md (5.2), or, without
        // an energy, if |R| is. An inverted state has an infinite energy, so it
        // is halved away like any other. The direction of a kept tangent may be
        // none of descent, so it is not worth halving: it is taken as a whole,
        // or refused by a step of length 0, after which the next iteration has
        // a tangent of its own. Armijo's constant has its usual value. After 30
        // halvings a step is 10⁻⁹ of the direction.
        constexpr double       armijo         = 1e-4;
        constexpr unsigned int max_reductions = 30;
        const auto            &old_group =
          dynamic_cast<const NoxGroup &>(solver.getPreviousSolutionGroup());
        auto &new_group = dynamic_cast<NoxGroup &>(group);

        const bool   is_kept  = old_group.has_kept_tangent();
        const double slope    = direction.innerProduct(old_group.getF());
        const auto  &before   = old_group.evaluation();
        const double slack    = rounding_error * before.energy_magnitude;
        const double compared = reference(before.energy);
        step                  = 1.;
        for (unsigned int i = 0; i < max_reductions; ++i, step *= 0.5)
          {
            new_group.computeX(old_group, direction, step);
            new_group.computeF();
            const double energy = new_group.evaluation().energy;
            const double norm   = new_group.getNormF();
            const bool   falls =
              norm <= (1. - armijo * step) * old_group.getNormF();
            const bool is_accepted =
              std::isfinite(energy) &&
              (!is_kept || norm <= old_group.getNormF()) &&
              (has_energy ? energy <= compared + armijo * step * slope + slack :
                            falls || norm <= rounding_error *
                                               problem.residual_magnitude(
                                                 values_of(new_group.getX())));
            const bool leaps =
              is_accepted && has_energy && norm > old_group.getNormF() &&
              energy > before.energy + slack && old_group.is_unresisted();
            if (is_accepted && !leaps)
              return true;
            // A leap ends the solve where it is.
            if (is_kept || leaps)
              {
                new_group.computeX(old_group, direction, step = 0.);
                new_group.computeF();
                return !leaps;
              }
          }
        step = 0.; // any other length NOX would take for a recovery step
        return false;
      }

    private:
      /** The energy that the next state is compared with, given that of the
       *  @p present one. */
      double
      reference(const double present)
      {
        // The state where a solve starts has the growth of the whole step, and
        // so an energy that would admit anything: it is compared with, once,
        // but not remembered.
        if (!has_begun)
          {
            has_begun = true;
            return present;
          }
        accepted.push_back(present);
        if (accepted.size() > memory)
          accepted.pop_front();
        return *std::max_element(accepted.begin(), accepted.end());
      }

      const Equilibrium &problem;
      const bool         has_energy;
      bool               has_begun = false;
      std::deque<double> accepted; // the last energies, without the first
    };


    /** How NOX wants to be given it. */
    struct Factory : public NOX::LineSearch::UserDefinedFactory
    {
      Teuchos::RCP<NOX::LineSearch::Generic>
      buildLineSearch(const Teuchos::RCP<NOX::GlobalData> &,
                      Teuchos::ParameterList &) const override
      {
        return search;
      }

      Teuchos::RCP<NOX::LineSearch::Generic> search;
    };

    Teuchos::RCP<Teuchos::ParameterList>
    nox_parameters(const Equilibrium &problem,
                   const bool         has_energy,
                   const double       linear_tolerance)
    {
      // NOX's method is Newton's with a line search, where nothing else is
      // said. The message of StepFailed says what has failed. NOX would print
      // failed line searches even where no output information is wanted.
      const auto parameters = Teuchos::rcp(new Teuchos::ParameterList);
      const Teuchos::RCP<std::ostream> nowhere =
        Teuchos::rcp(new Teuchos::oblackholestream);
      parameters->sublist("Printing")
        .set("Output Information", 0)
        .set("Output Stream", nowhere)
        .set("Error Stream", nowhere);

      Teuchos::ParameterList &newton =
        parameters->sublist("Direction").sublist("Newton");
      // Type 2 is Eisenstat and Walker's second choice: doc/theory.md, section
      // 5.4. Early solves need few digits, as the next tangent differs anyway;
      // the first tolerance is 1e-2, and none is looser than 1e-1. Later ones
      // follow the fall of the residual down to 1e-6. NOX needs the last set().
      newton.set("Forcing Term Method",
                 linear_tolerance > 0. ? "Constant" : "Type 2");
      newton.sublist("Linear Solver").set("Tolerance", linear_tolerance);
      newton.set("Forcing Term Initial Tolerance", 1e-2);
      newton.set("Forcing Term Maximum Tolerance", 1e-1);
      newton.set("Forcing Term Minimum Tolerance", 1e-6);
      newton.set("Set Tolerance in Parameter List", true);
      newton.set("Rescue Bad Newton Solve", false);

      Teuchos::ParameterList &search = parameters->sublist("Line Search");
      search.set("Method", "User Defined");
      const auto factory = Teuchos::rcp(new Factory);
      factory->search = Teuchos::rcp(new EnergyLineSearch(problem, has_energy));
      search.set<Teuchos::RCP<NOX::LineSearch::UserDefinedFactory>>(
        "User Defined Line Search Factory", factory);
      return parameters;
    }

    /** What @p run returns, or the message of a failure that it throws. */
    std::string
    message_of(const std::function<std::string()> &run)
    {
      try
        {
          return run();
        }
      catch (const StepFailed &error)
        {
          return error.what();
        }
      catch (const char *message) // NOX before Trilinos 14.2
        {
          return message;
        }
      catch (const std::runtime_error &error) // and since
        {
          // Errors that are not NOX's own are passed on.
          if (std::string(error.what()).find("NOX") == std::string::npos)
            throw;
          return error.what();
        }
    }
  } // namespace

  Equilibrium::Evaluation
  solve(Equilibrium            &problem,
        const LinearProblem    &linear_problem,
        const NewtonScales     &scales,
        const SolverParameters &parameters,
        TimerOutput            &timer,
        Equilibrium::Vector    &u,
        NewtonReport           &report,
        const OnTheWay         &on_the_way)
  {
    // The start u and the rounding error of its residual give the bound of
    // doc/theory.md (5.3): a start that is below it is the solution already,
    // and NOX never runs. Else NOX iterates with our group, line search and
    // convergence test. Where what is held fixed is renewed, NOX begins anew,
    // as its line search compares energies, while tangents and preconditioner
    // are kept. In the end u and the report have its last state.
    Tangents     tangents(problem, linear_problem.costly);
    LinearSolver linear_solver(parameters, linear_problem, timer);
    const auto   group    = Teuchos::rcp(new NoxGroup(
      problem, linear_problem, tangents, linear_solver, report, u));
    const double rounding = group->compute_with_rounding();
    if (!std::isfinite(group->evaluation().energy))
      throw StepFailed(
        "where the step begins, the growth, loads and fixed places of its end "
        "invert a cell or a boundary point: there is no state to start from");
    const double first = group->getNormF();
    const double bound = std::max(parameters.newton_tolerance *
                                    std::max(first, scales.small_force),
                                  rounding);
    if (report.first_residual == 0.)
      report.first_residual = first;
    const auto relative = [&](const double norm) {
      return norm > 0. ? norm / report.first_residual : 0.;
    };
    report.residual     = relative(first);
    report.ends_at_leap = false;
    if (first <= bound)
      return group->evaluation();

    const ConvergenceTest::Bounds bounds{bound,
                                         rounding,
                                         parameters.newton_tolerance *
                                           scales.length,
                                         parameters.newton_iterations};
    bool                          may_renew = bool(on_the_way.renew);
    const std::string             reason    = message_of([&]() {
      for (;;)
        {
          const auto test   = Teuchos::rcp(new ConvergenceTest(
            bounds, tangents, linear_problem.symmetric, on_the_way, report));
          const auto solver = NOX::Solver::buildSolver(
            group,
            test,
            nox_parameters(problem,
                           linear_problem.symmetric,
                           parameters.linear_tolerance));
          double before = group->getNormF();
          for (bool renewed = false; !renewed; before = group->getNormF())
            {
              const bool is_early =
                may_renew && report.place.turn < last_early_turn &&
                solver->getNumIterations() < early_iterations;
              linear_solver.largest_tolerance =
                is_early && parameters.linear_tolerance == 0. ? exact : 1.;
              if (solver->step() != NOX::StatusTest::Unconverged)
                return test->reason_of_failure();
              if (is_early && group->part_taken() == 1. &&
                  group->getNormF() <= early * before &&
                  last_motion(*solver) <= scales.length)
                may_renew = renewed =
                  on_the_way.renew(values_of(group->getX()));
            }
          group->renew();
          ++report.turns;
          ++report.place.turn;
        }
    });
    u                                       = values_of(group->getX());
    report.residual                         = relative(group->getNormF());
    // Below its bound rounding, not the equilibrium, has stopped the search. A
    // leap leaves open how far its motion goes, which a path decides.
    const bool leaps = report.ends_at_leap && report.proximal_paths == 0;
    if (!leaps && group->isF() && std::isfinite(group->evaluation().energy) &&
        group->getNormF() <= bound)
      return group->evaluation();
    throw StepFailed("Newton's method has not converged: " + reason);
  }
} // namespace Morula
