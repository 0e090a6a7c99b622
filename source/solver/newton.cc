// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/linear_solver.h>
#include <morula/solver/newton.h>
#include <morula/solver/nox_group.h>

#include <NOX_LineSearch_UserDefinedFactory.H>
#include <NOX_Solver_Factory.H>
#include <NOX_Solver_Generic.H>
#include <NOX_StatusTest_Generic.H>
#include <NOX_Utils.H>
#include <Teuchos_ParameterList.hpp>
#include <Teuchos_oblackholestream.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace Morula
{
  namespace
  {
    constexpr int max_newton_iterations = 30;

    class EnergyLineSearchFactory : public NOX::LineSearch::UserDefinedFactory
    {
    public:
      EnergyLineSearchFactory(const Equilibrium &problem, const bool has_energy)
        : problem(problem)
        , has_energy(has_energy)
      {}

      Teuchos::RCP<NOX::LineSearch::Generic>
      buildLineSearch(const Teuchos::RCP<NOX::GlobalData> &,
                      Teuchos::ParameterList &) const override
      {
        return Teuchos::rcp(new EnergyLineSearch(problem, has_energy));
      }

    private:
      const Equilibrium &problem;
      const bool         has_energy;
    };

    /** Converged where both the unbalanced forces and what they may still
     *  move are below their bounds; failed where there is no hope of it. */
    class ConvergenceTest : public NOX::StatusTest::Generic
    {
    public:
      struct Bounds
      {
        double residual;     // kPa µm^(dim-1)
        double rounding;     // of the residual: below it nothing more is asked
        double displacement; // µm
      };

      ConvergenceTest(const Bounds &bounds, const Tangents &tangents)
        : bounds(bounds)
        , tangents(tangents)
      {}

      NOX::StatusTest::StatusType
      checkStatus(const NOX::Solver::Generic &solver,
                  NOX::StatusTest::CheckType) override
      {
        const double norm      = solver.getSolutionGroup().getNormF();
        const int    iteration = solver.getNumIterations();
        has_risen              = has_risen || norm > last_norm;
        last_norm              = norm;
        status                 = NOX::StatusTest::Failed;
        if (norm <= bounds.rounding ||
            (norm <= bounds.residual &&
             (iteration == 0 ||
              left_over(solver) <=
                (tangents.kept() ? part_of_kept : 1.) * bounds.displacement)))
          status = NOX::StatusTest::Converged;
        else if (!std::isfinite(norm))
          reason = "the unbalanced forces are infinite";
        else if (iteration >= max_newton_iterations)
          reason = "they have not converged in " +
                   std::to_string(max_newton_iterations) + " iterations";
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
        const auto &now    = solver.getSolutionGroup();
        const auto &before = solver.getPreviousSolutionGroup();
        const auto  change = now.getX().clone();
        change->update(-1., before.getX(), 1.);
        const double size = change->norm(NOX::Abstract::Vector::MaxNorm);
        if (!(size > 0.))
          return std::numeric_limits<double>::infinity();
        return has_risen ? size : size * now.getNormF() / before.getNormF();
      }

      /** Of the bound of displacements. An iteration with a tangent of its own
       *  ends far below the bounds, one with a kept tangent anywhere below. */
      static constexpr double part_of_kept = 0.1;

      const Bounds    bounds;
      const Tangents &tangents;
      double          last_norm = std::numeric_limits<double>::infinity();
      bool            has_risen = false; // the residual, in any iteration
      std::string     reason    = "no part of Newton's step has a lower energy";
      NOX::StatusTest::StatusType status = NOX::StatusTest::Unevaluated;
    };

    Teuchos::RCP<Teuchos::ParameterList>
    nox_parameters(const Equilibrium &problem,
                   const bool         has_energy,
                   const double       linear_tolerance)
    {
      const auto parameters = Teuchos::rcp(new Teuchos::ParameterList);
      parameters->set("Nonlinear Solver", "Line Search Based");
      // StepFailed says what has failed; NOX prints failed line searches even
      // where no output information is wanted.
      const Teuchos::RCP<std::ostream> nowhere =
        Teuchos::rcp(new Teuchos::oblackholestream);
      parameters->sublist("Printing")
        .set("Output Information", 0)
        .set("Output Stream", nowhere)
        .set("Error Stream", nowhere);

      Teuchos::ParameterList &newton =
        parameters->sublist("Direction").sublist("Newton");
      parameters->sublist("Direction").set("Method", "Newton");
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
      const Teuchos::RCP<NOX::LineSearch::UserDefinedFactory> factory =
        Teuchos::rcp(new EnergyLineSearchFactory(problem, has_energy));
      search.set("User Defined Line Search Factory", factory);
      return parameters;
    }
  } // namespace

  Equilibrium::Evaluation
  solve(Equilibrium            &problem,
        const LinearProblem    &linear_problem,
        const NewtonScales     &scales,
        const SolverParameters &parameters,
        TimerOutput            &timer,
        Equilibrium::Vector    &u,
        NewtonReport           &report)
  {
    Tangents     tangents(problem, linear_problem.costly);
    LinearSolver linear_solver(parameters, linear_problem, timer);
    const auto   group    = Teuchos::rcp(new NoxGroup(
      problem, linear_problem, tangents, linear_solver, report, u));
    const double rounding = group->compute_with_rounding();
    if (!std::isfinite(group->evaluation().energy))
      throw StepFailed("there is no state to start from");
    const double first = group->getNormF();
    const double bound = std::max(parameters.newton_tolerance *
                                    std::max(first, scales.small_force),
                                  rounding);
    report.residual    = first > 0. ? 1. : 0.;
    if (first <= bound)
      return group->evaluation();

    ConvergenceTest::Bounds bounds;
    bounds.residual     = bound;
    bounds.rounding     = rounding;
    bounds.displacement = parameters.newton_tolerance * scales.length;
    const auto  test    = Teuchos::rcp(new ConvergenceTest(bounds, tangents));
    std::string reason  = "Newton's method has not converged: ";
    try
      {
        NOX::Solver::buildSolver(group,
                                 test,
                                 nox_parameters(problem,
                                                linear_problem.symmetric,
                                                parameters.linear_tolerance))
          ->solve();
        reason += test->reason_of_failure();
      }
    catch (const StepFailed &error)
      {
        reason += error.what();
      }
    catch (const char *message) // NOX before Trilinos 14.2
      {
        reason += message;
      }
    catch (const std::runtime_error &error) // and since
      {
        if (std::string(error.what()).find("NOX") == std::string::npos)
          throw;
        reason += error.what();
      }
    u               = values_of(group->getX());
    report.residual = group->getNormF() / first;
    // Converged already: a failed line search does not matter.
    if (group->isF() && std::isfinite(group->evaluation().energy) &&
        group->getNormF() <= bound)
      return group->evaluation();
    if (linear_solver.largest_shift() > 0.)
      reason += ". The tangent was indefinite: the body is unstable (it "
                "buckles or folds, or its material is stretched so far that "
                "it has lost its ellipticity)";
    throw StepFailed(reason);
  }
} // namespace Morula
