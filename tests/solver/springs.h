// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_solver_springs_h
#define morula_tests_solver_springs_h

#include <morula/solver/newton.h>

#include <functional>
#include <string>

#include "common/linear_problem.h"

namespace Morula
{
  /** Between 1/100 and 100. */
  inline double
  uneven_spring(const unsigned int i)
  {
    return std::pow(10., 2. * std::sin(1. * i));
  }

  /** A chain of springs (between i and i + 1) on a foundation, and with a part
   *  @p skew that has no energy. */
  inline ChainProblem
  chain_of_springs(
    const unsigned int                         n,
    const double                               foundation,
    const double                               skew   = 0.,
    const std::function<double(unsigned int)> &spring = uneven_spring)
  {
    ChainProblem problem(n);
    problem.stiffness =
      [=](const unsigned int i, const unsigned int j, const auto &) {
        if (i != j)
          return -spring(std::min(i, j)) + (i < j ? skew : -skew);
        return foundation + (i > 0 ? spring(i - 1) : 0.) +
               (i + 1 < n ? spring(i) : 0.);
      };
    problem.linear.symmetric = skew == 0.;
    return problem;
  }

  /** Where Newton's method comes to from zero, and what it notes down. */
  struct Outcome
  {
    std::vector<double> u;
    NewtonReport        report;
    std::string         failure; // empty where it has converged
  };

  inline Outcome
  outcome(ChainProblem      &problem,
          const double       tolerance,
          const std::string &linear_solver = "automatic",
          const unsigned int iterations = SolverParameters().newton_iterations)
  {
    QuietTimer       timer;
    SolverParameters parameters;
    parameters.newton_tolerance  = tolerance;
    parameters.linear_solver     = linear_solver;
    parameters.newton_iterations = iterations;
    Equilibrium::Vector u        = problem.zero();
    Outcome             result;
    result.report.wants_trace = true;
    try
      {
        solve(problem,
              problem.linear,
              problem.scales,
              parameters,
              timer,
              u,
              result.report);
      }
    catch (const StepFailed &failure)
      {
        result.failure = failure.what();
      }
    result.u = problem.gathered(u);
    return result;
  }
} // namespace Morula

#endif
