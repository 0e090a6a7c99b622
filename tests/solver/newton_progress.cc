// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// When Newton's method goes on, when it ends, and what it notes down.
#include "solver/room.h"

constexpr unsigned int n_unknowns = 12;


// Rosenbrock's valley in each pair of unknowns: a search that must lower the
// energy in every iteration follows its bend in shorter steps.
TEST(NewtonProgress, GoesOnAlongACurvedValley)
{
  ChainProblem     problem(n_unknowns);
  constexpr double stiff = 1e4;
  const auto pair = [](const unsigned int i, const std::vector<double> &u) {
    return std::make_pair(u[i - i % 2] - 1.2, u[i - i % 2 + 1] + 1.);
  };
  problem.energy = [&](const std::vector<double> &u) {
    double sum = 0.;
    for (unsigned int i = 0; i < n_unknowns; i += 2)
      {
        const auto [x, y] = pair(i, u);
        sum += stiff * std::pow(y - x * x, 2) + std::pow(1. - x, 2);
      }
    return sum;
  };
  problem.force = [&](const unsigned int i, const std::vector<double> &u) {
    const auto [x, y]   = pair(i, u);
    const double across = 2. * stiff * (y - x * x);
    return i % 2 == 1 ? across : -2. * x * across - 2. * (1. - x);
  };
  problem.stiffness = [&](const unsigned int         i,
                          const unsigned int         j,
                          const std::vector<double> &u) {
    const auto [x, y] = pair(i, u);
    if (i / 2 != j / 2)
      return 0.;
    if (i != j)
      return -4. * stiff * x;
    return i % 2 == 1 ? 2. * stiff : 12. * stiff * x * x - 4. * stiff * y + 2.;
  };
  problem.linear.costly = false;
  const Outcome result  = outcome(problem, 1e-10, "direct");
  EXPECT_EQ(result.failure, "");
  EXPECT_GT(result.report.newton_iterations, 30u);
  EXPECT_LT(result.report.newton_iterations, 65u);
  for (unsigned int i = 0; i < n_unknowns; ++i)
    EXPECT_NEAR(result.u[i], i % 2 == 0 ? 2.2 : 0., 1e-8);
}


/** Pairs of unknowns whose difference m is resisted by @p softness only, while
 *  their sum s is drawn to 1 + m² by a spring that is less stiff near there.
 * The lowest energy has m = 1/2. */
ChainProblem
soft_differences(const double softness)
{
  ChainProblem problem(n_unknowns);
  struct Pair
  {
    Pair(const unsigned int i, const std::vector<double> &u)
      : m((u[i - i % 2] - u[i - i % 2 + 1]) / std::sqrt(2.))
      , t((u[i - i % 2] + u[i - i % 2 + 1]) / std::sqrt(2.) - 1. - m * m)
    {}

    const double m, t;
  };
  problem.energy = [=](const std::vector<double> &u) {
    double sum = 0.;
    for (unsigned int i = 0; i < n_unknowns; i += 2)
      {
        const Pair p(i, u);
        sum += 0.5 * p.t * p.t + 0.25 * std::pow(p.t, 4) +
               0.5 * softness * (p.m * p.m - p.m);
      }
    return sum;
  };
  problem.force = [=](const unsigned int i, const std::vector<double> &u) {
    const Pair   p(i, u);
    const double along_s = p.t + std::pow(p.t, 3);
    const double along_m = -2. * p.m * along_s + softness * (p.m - 0.5);
    return (along_s + (i % 2 == 0 ? along_m : -along_m)) / std::sqrt(2.);
  };
  problem.stiffness = [=](const unsigned int         i,
                          const unsigned int         j,
                          const std::vector<double> &u) {
    const Pair   p(i, u);
    const double ss = 1. + 3. * p.t * p.t;
    const double sm = -2. * p.m * ss;
    const double mm =
      4. * p.m * p.m * ss - 2. * (p.t + std::pow(p.t, 3)) + softness;
    if (i / 2 != j / 2)
      return 0.;
    if (i != j)
      return 0.5 * (ss - mm);
    return 0.5 * (ss + mm) + (i % 2 == 0 ? sm : -sm);
  };
  problem.linear.costly = false;
  return problem;
}


// A leap along m makes energy and residual larger. What resists m tells whether
// it is taken.
TEST(NewtonProgress, EndsBeforeALeapThatNothingResists)
{
  ChainProblem  soft   = soft_differences(1e-4);
  const Outcome leapt  = outcome(soft, 1e-11, "direct");
  bool          climbs = false;
  for (std::size_t k = 1; k < leapt.report.trace.size(); ++k)
    climbs = climbs || (leapt.report.trace[k].evaluation.energy >
                        leapt.report.trace[k - 1].evaluation.energy + 0.01);
  EXPECT_EQ(leapt.failure, "");
  EXPECT_TRUE(climbs);
  EXPECT_FALSE(leapt.report.ends_at_leap);
  EXPECT_NEAR(leapt.u[0] - leapt.u[1], 0.5 * std::sqrt(2.), 1e-8);

  ChainProblem  unresisted = soft_differences(1e-9);
  const Outcome ended      = outcome(unresisted, 1e-11, "direct");
  EXPECT_NE(ended.failure, "");
  EXPECT_TRUE(ended.report.ends_at_leap);
  EXPECT_LT(ended.report.residual, 1e-6);
  EXPECT_LT(ended.report.newton_iterations, 10u);
  EXPECT_NEAR(ended.u[0] - ended.u[1], 0., 0.01);
  EXPECT_NEAR(ended.u[0] + ended.u[1], std::sqrt(2.), 0.01);
}


// The energy's rounding hides that nothing gets better.
TEST(NewtonProgress, EndsWithoutIt)
{
  ChainProblem problem = alike(
    n_unknowns,
    [](double) { return 1e14; },
    [](double) { return 1.; },
    [](double) { return 1.; });
  problem.linear.costly = false;
  const Outcome result  = outcome(problem, 1e-6);
  expect_parts(result.failure, {"20 iterations"});
  EXPECT_EQ(result.report.newton_iterations, 20u);
}


// Without an energy the residual falls for ever, by less than a hundredth in
// twenty iterations.
TEST(NewtonProgress, IsMoreThanAResidualThatCreeps)
{
  ChainProblem problem = alike(
    n_unknowns,
    [](double) { return 0.; },
    [](double u) { return 1. + 1. / (1. + u); },
    [](double) { return -3000.; });
  problem.linear.symmetric = false;
  problem.linear.costly    = false;
  const Outcome result     = outcome(problem, 1e-6);
  expect_parts(result.failure, {"20 iterations"});
  const auto &trace = result.report.trace;
  ASSERT_EQ(trace.size(), 21u);
  for (std::size_t k = 1; k < trace.size(); ++k)
    EXPECT_LT(trace[k].residual, trace[k - 1].residual);
}


// The energy falls for ever.
TEST(NewtonProgress, EndsAtTheLimitOfIterations)
{
  ChainProblem problem = alike(
    n_unknowns,
    [](double u) { return -u; },
    [](double) { return -1.; },
    [](double) { return 1.; });
  problem.linear.costly = false;
  const Outcome result  = outcome(problem, 1e-6, "automatic", 37);
  expect_parts(result.failure, {"Solver/Newton iterations = 37"});
  EXPECT_EQ(result.report.newton_iterations, 37u);
}


TEST(NewtonProgress, IsNotedDown)
{
  ChainProblem problem = alike(
    n_unknowns,
    [](double u) { return std::pow(u * u - 1., 2) - 0.1 * u; },
    [](double u) { return 4. * u * (u * u - 1.) - 0.1; },
    [](double u) { return 12. * u * u - 4.; });
  problem.linear.costly = false;
  const Outcome result  = outcome(problem, SolverParameters().newton_tolerance);
  const auto   &trace   = result.report.trace;
  ASSERT_EQ(trace.size(), result.report.newton_iterations + 1);
  EXPECT_NEAR(trace[0].evaluation.energy, n_unknowns, 1e-12);
  EXPECT_NEAR(trace[0].residual, 0.1 * std::sqrt(n_unknowns), 1e-12);
  // On the hill all directions have the diagonal's own curvature.
  EXPECT_NEAR(trace[1].curvature, -1., 1e-9);
  EXPECT_GT(trace[1].motion, 0.);
  for (std::size_t k = 1; k < trace.size(); ++k)
    {
      EXPECT_EQ(trace[k].iteration, k);
      EXPECT_GT(trace[k].part, 0.);
    }
  EXPECT_EQ(trace.back().curvature, 0.);
}
