// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "solver/room.h"

constexpr unsigned int n = 6;

/** Double wells in a row whose tangent at the start is negative, tied to each
 *  other by springs. */
ChainProblem
wells()
{
  ChainProblem problem(n);
  problem.energy = [](const std::vector<double> &u) {
    double sum = 0.;
    for (unsigned int i = 0; i < n; ++i)
      {
        sum += std::pow(u[i] * u[i] - 1., 2) - 0.1 * u[i];
        if (i + 1 < n)
          sum += 0.5 * std::pow(u[i] - u[i + 1], 2);
      }
    return sum;
  };
  problem.force = [](const unsigned int i, const std::vector<double> &u) {
    double f = 4. * u[i] * (u[i] * u[i] - 1.) - 0.1;
    if (i > 0)
      f += u[i] - u[i - 1];
    if (i + 1 < n)
      f += u[i] - u[i + 1];
    return f;
  };
  problem.stiffness = [](const unsigned int         i,
                         const unsigned int         j,
                         const std::vector<double> &u) {
    if (i != j)
      return -1.;
    return 12. * u[i] * u[i] - 4. + (i > 0 ? 1. : 0.) + (i + 1 < n ? 1. : 0.);
  };
  problem.linear.costly = false;
  return problem;
}

std::vector<double>
followed(ChainProblem &problem, NewtonReport &report)
{
  QuietTimer          timer;
  SolverParameters    parameters;
  Equilibrium::Vector u = problem.zero();
  follow_proximal_path(
    problem, problem.linear, problem.scales, parameters, timer, u, report);
  return problem.gathered(u);
}


// The friction is gone at the end, and the energy has fallen from part to part.
TEST(ProximalPath, EndsAtATrueEquilibrium)
{
  ChainProblem problem = wells();
  NewtonReport report;
  report.wants_trace          = true;
  const std::vector<double> u = followed(problem, report);
  EXPECT_EQ(report.proximal_paths, 1u);
  for (unsigned int i = 0; i < n; ++i)
    {
      EXPECT_NEAR(problem.force(i, u), 0., 1e-6);
      EXPECT_GT(u[i], 0.9);
    }
  ASSERT_FALSE(report.trace.empty());
  EXPECT_EQ(report.trace.front().place.proximity, 1e-3);
  EXPECT_EQ(report.place.proximity, 0.);
  // A part starts with the energy of the tissue alone.
  double before = std::numeric_limits<double>::infinity();
  for (const NewtonIteration &state : report.trace)
    if (state.iteration == 0)
      {
        EXPECT_LE(state.evaluation.energy, before + 1e-10);
        before = state.evaluation.energy;
      }
}


TEST(ProximalPath, TheProblemIsTheDerivativeOfItsEnergy)
{
  ChainProblem        problem = wells();
  ProximalEquilibrium nearby(problem);
  const auto centre = problem.vector_of({0.1, -0.2, 0.3, 0.5, -0.1, 0.2});
  const std::vector<double> x = {0.4, 0.1, -0.7, 0.6, 0.2, -0.3};
  nearby.set(centre, 0.7);
  nearby.tangent(centre, GrowthAt::current); // now D is known
  Equilibrium::Vector R = problem.zero();
  nearby.residual(problem.vector_of(x), R);
  const std::vector<double> forces = problem.gathered(R);
  const auto &K = nearby.tangent(problem.vector_of(x), GrowthAt::current);
  for (unsigned int j = 0; j < n; ++j)
    {
      const double        eps  = 1e-5;
      std::vector<double> more = x, less = x;
      more[j] += eps;
      less[j] -= eps;
      Equilibrium::Vector R_more = problem.zero(), R_less = problem.zero();
      const double        rise =
        nearby.residual(problem.vector_of(more), R_more).energy -
        nearby.residual(problem.vector_of(less), R_less).energy;
      EXPECT_NEAR(forces[j], rise / (2. * eps), 1e-7);
      R_more -= R_less;
      const std::vector<double> column = problem.gathered(R_more);
      std::vector<double>       unit(n, 0.);
      unit[j] = 1.;
      K.vmult(R, problem.vector_of(unit));
      for (unsigned int i = 0; i < n; ++i)
        EXPECT_NEAR(problem.gathered(R)[i], column[i] / (2. * eps), 1e-6);
    }
}


// Without an equilibrium the path ends, with the work that was done.
TEST(ProximalPath, FailsWithoutAnEquilibrium)
{
  ChainProblem problem(n);
  problem.energy = [](const std::vector<double> &u) {
    double sum = 0.;
    for (const double x : u)
      sum -= x;
    return sum;
  };
  problem.force = [](unsigned int, const std::vector<double> &) { return -1.; };
  problem.stiffness = [](const unsigned int i,
                         const unsigned int j,
                         const std::vector<double> &) {
    return i == j ? 1e-3 : 0.;
  };
  problem.linear.costly = false;
  NewtonReport report;
  EXPECT_THROW(followed(problem, report), StepFailed);
  EXPECT_EQ(report.place.proximity, 0.);
}
