// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/linear_solver.h>
#include <morula/mechanics/newton.h>
#include <morula/mechanics/nox_group.h>

#include <NOX_LineSearch_UserDefinedFactory.H>
#include <NOX_Solver_Factory.H>
#include <NOX_Solver_Generic.H>
#include <NOX_StatusTest_Generic.H>
#include <NOX_Utils.H>
#include <Teuchos_ParameterList.hpp>

#include <algorithm>

namespace Morula
{
  namespace
  {
    constexpr int max_iterations = 30;

    class EnergyLineSearchFactory : public NOX::LineSearch::UserDefinedFactory
    {
    public:
      explicit EnergyLineSearchFactory(const Equilibrium &problem)
        : problem(problem)
      {}

      Teuchos::RCP<NOX::LineSearch::Generic>
      buildLineSearch(const Teuchos::RCP<NOX::GlobalData> &,
                      Teuchos::ParameterList &) const override
      {
        return Teuchos::rcp(new EnergyLineSearch(problem));
      }

    private:
      const Equilibrium &problem;
    };

    /** Converged below a bound; failed after too many iterations or where the
     *  residual is no number. */
    class ResidualTest : public NOX::StatusTest::Generic
    {
    public:
      explicit ResidualTest(const double bound)
        : bound(bound)
      {}

      NOX::StatusTest::StatusType
      checkStatus(const NOX::Solver::Generic &solver,
                  NOX::StatusTest::CheckType) override
      {
        const double norm = solver.getSolutionGroup().getNormF();
        if (norm <= bound)
          status = NOX::StatusTest::Converged;
        else if (!std::isfinite(norm) ||
                 solver.getNumIterations() >= max_iterations)
          status = NOX::StatusTest::Failed;
        else
          status = NOX::StatusTest::Unconverged;
        return status;
      }

      NOX::StatusTest::StatusType
      getStatus() const override
      {
        return status;
      }

      std::ostream &
      print(std::ostream &stream, int) const override
      {
        return stream << "|R| <= " << bound << '\n';
      }

    private:
      const double                bound;
      NOX::StatusTest::StatusType status = NOX::StatusTest::Unevaluated;
    };

    Teuchos::RCP<Teuchos::ParameterList>
    nox_parameters(const Equilibrium &problem, const double linear_tolerance)
    {
      const auto parameters = Teuchos::rcp(new Teuchos::ParameterList);
      parameters->set("Nonlinear Solver", "Line Search Based");
      parameters->sublist("Printing")
        .set("Output Information", int(NOX::Utils::Error));

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
        Teuchos::rcp(new EnergyLineSearchFactory(problem));
      search.set("User Defined Line Search Factory", factory);
      return parameters;
    }
  } // namespace

  void
  solve(Equilibrium            &problem,
        const SolverParameters &parameters,
        TimerOutput            &timer,
        Equilibrium::Vector    &u,
        NewtonReport           &report)
  {
    problem.initialize(u);
    LinearSolver linear_solver(parameters, problem, timer);
    const auto   group =
      Teuchos::rcp(new NoxGroup(problem, linear_solver, report, u));
    group->computeF();
    if (!std::isfinite(group->evaluation().energy))
      throw StepFailed("the tissue is inverted at the start of the step");
    const double first = group->getNormF();
    const double bound = std::max(parameters.newton_tolerance *
                                    std::max(first, problem.small_force()),
                                  problem.rounding(u));
    report.residual    = first > 0. ? 1. : 0.;
    if (first <= bound)
      return;

    const auto                  test   = Teuchos::rcp(new ResidualTest(bound));
    NOX::StatusTest::StatusType status = NOX::StatusTest::Failed;
    try
      {
        const auto solver = NOX::Solver::buildSolver(
          group, test, nox_parameters(problem, parameters.linear_tolerance));
        status          = solver->solve();
        u               = values_of(solver->getSolutionGroup().getX());
        report.residual = solver->getSolutionGroup().getNormF() / first;
      }
    catch (const char *message)
      {
        throw StepFailed(message);
      }
    if (status != NOX::StatusTest::Converged)
      throw StepFailed("Newton's method did not converge");
  }
} // namespace Morula
