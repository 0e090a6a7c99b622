// ranks: 1 2 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/linear_solver.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "common/linear_problem.h"

using namespace Morula;

namespace
{
  constexpr unsigned int n = 60;

  std::vector<double>
  random_values(const unsigned int seed)
  {
    std::mt19937                           generator(seed);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    std::vector<double>                    values(n);
    for (double &value : values)
      value = uniform(generator);
    return values;
  }

  /** A chain of springs of very different stiffness, on a foundation, and with
   *  a part @p skew that has no energy. */
  ChainProblem
  chain(const double foundation, const double skew = 0.)
  {
    const auto spring = [](const unsigned int i) {
      return std::pow(10., 2. * std::sin(1. * i)); // between i and i + 1
    };
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

  SolverParameters
  parameters(const std::string &solver)
  {
    SolverParameters result;
    result.linear_solver = solver;
    return result;
  }

  /** |K x - b| / |b| */
  double
  defect(const Equilibrium::Matrix &K,
         const Equilibrium::Vector &x,
         const Equilibrium::Vector &b)
  {
    Equilibrium::Vector r(b);
    return K.residual(r, x, b) / b.l2_norm();
  }

  void
  check_solution(const std::string &solver, const double skew)
  {
    SCOPED_TRACE(solver);
    unsigned int ignored = 0;
    QuietTimer   timer;
    ChainProblem problem = chain(0.5, skew);
    LinearSolver linear_solver(parameters(solver), problem.linear, timer);
    Equilibrium::Vector zero     = problem.zero(), b, x;
    const auto         &K        = problem.tangent(zero, GrowthAt::current);
    const auto          solution = problem.vector_of(random_values(1));
    b                            = solution;
    K.vmult(b, solution);
    x                         = zero;
    unsigned int n_iterations = 0;
    linear_solver.solve(K, x, b, 1e-10, n_iterations);
    EXPECT_GE(n_iterations, 1u);
    EXPECT_LE(defect(K, x, b), 1e-9);
    x -= solution;
    EXPECT_LE(x.l2_norm(), 1e-7 * solution.l2_norm());

    // Of the same matrix the direct solver has a factor.
    Equilibrium::Vector again  = zero;
    unsigned int        n_kept = 0;
    linear_solver.solve(K, again, b, 1e-10, n_kept, true);
    EXPECT_EQ(n_kept, solver == "direct" ? 0 : n_iterations);
    again -= solution;
    again -= x; // less the solution, too
    EXPECT_LE(again.l2_norm(), 1e-14 * solution.l2_norm());

    // A loose tolerance is no more work, and the preconditioner serves for
    // another matrix.
    x                    = zero;
    unsigned int n_loose = 0;
    linear_solver.solve(K, x, b, 1e-2, n_loose);
    EXPECT_LE(n_loose, n_iterations);
    EXPECT_LE(defect(K, x, b), 2e-2);
    const auto spring = problem.stiffness;
    problem.stiffness =
      [&](const unsigned int i, const unsigned int j, const auto &u) {
        return spring(i, j, u) + (i == j ? 0.3 * (i % 4) : 0.);
      };
    const auto &other = problem.tangent(zero, GrowthAt::current);
    linear_solver.solve(other, x, b, 1e-8, ignored);
    EXPECT_LE(defect(other, x, b), 1e-7);
  }

  /** With a part that fills the matrix, far stiffer than the rest. */
  void
  check_rank_one(const std::string &solver, const double skew)
  {
    SCOPED_TRACE(solver);
    unsigned int ignored = 0;
    QuietTimer   timer;
    ChainProblem problem = chain(0.5, skew);
    LinearSolver linear_solver(parameters(solver), problem.linear, timer);
    Equilibrium::Vector        x        = problem.zero();
    const auto                &K        = problem.tangent(x, GrowthAt::current);
    const auto                 solution = problem.vector_of(random_values(1));
    const Equilibrium::RankOne part{problem.vector_of(random_values(6)), 1e3};
    Equilibrium::Vector        b(solution);
    K.vmult(b, solution);
    b.add(part.factor * (part.b * solution), part.b);
    linear_solver.solve(K, x, b, 1e-11, ignored, false, &part);
    x -= solution;
    EXPECT_LE(x.l2_norm(), 1e-5 * solution.l2_norm());
  }

  /** A diagonal of both signs; a shift turns all of it positive. */
  void
  check_indefinite(const std::string &solver)
  {
    SCOPED_TRACE(solver);
    unsigned int ignored = 0;
    QuietTimer   timer;
    ChainProblem problem(n);
    const auto   entry = [](const unsigned int i) {
      return i % 3 == 0 ? -1. - 0.01 * i : 2. + 0.1 * i;
    };
    problem.stiffness = [&](const unsigned int i,
                            const unsigned int j,
                            auto &) { return i == j ? entry(i) : 0.; };
    LinearSolver linear_solver(parameters(solver), problem.linear, timer);
    Equilibrium::Vector x = problem.zero();
    const auto         &K = problem.tangent(x, GrowthAt::current);
    for (unsigned int seed = 1; seed <= 5; ++seed)
      {
        // Mostly where the curvature is negative.
        auto values = random_values(seed);
        for (unsigned int i = 0; i < n; ++i)
          if (i % 3 != 0)
            values[i] *= 0.05;
        const auto b = problem.vector_of(values);
        linear_solver.solve(K, x, b, 1e-6, ignored);
        EXPECT_TRUE(std::isfinite(x.l2_norm()));
        EXPECT_GT(x * b, 0.); // b = -R: downhill
        EXPECT_TRUE(linear_solver.has_shifted());
        linear_solver.solve(K, x, b, 1e-6, ignored, true);
        EXPECT_GT(x * b, 0.);
      }
  }

  /** Free to move as a whole: the loads' mean does not count. */
  void
  check_null_space(const std::string &solver)
  {
    SCOPED_TRACE(solver);
    unsigned int ignored = 0;
    QuietTimer   timer;
    ChainProblem problem = chain(0.);
    problem.linear.null_space.push_back(
      problem.vector_of(std::vector<double>(n, 1. / std::sqrt(1. * n))));
    LinearSolver linear_solver(parameters(solver), problem.linear, timer);
    Equilibrium::Vector x        = problem.zero();
    const auto         &K        = problem.tangent(x, GrowthAt::current);
    auto                balanced = problem.vector_of(random_values(2));
    auto                b        = balanced;
    balanced.add(-(b * problem.linear.null_space[0]),
                 problem.linear.null_space[0]);
    linear_solver.solve(K, x, b, 1e-9, ignored);
    EXPECT_NEAR(x * problem.linear.null_space[0], 0., 1e-9 * x.l2_norm());
    EXPECT_FALSE(linear_solver.has_shifted());
    Equilibrium::Vector again = problem.zero();
    linear_solver.solve(K, again, b, 1e-9, ignored, true);
    again -= x;
    EXPECT_EQ(again.l2_norm(), 0.);
    // The direct solver shifts the diagonal a little.
    EXPECT_LE(defect(K, x, balanced), solver == "direct" ? 1e-3 : 1e-8);
  }
} // namespace


TEST(LinearSolver, SolvesSymmetricSystems)
{
  check_solution("automatic", 0.);
  check_solution("iterative", 0.);
  check_solution("direct", 0.);
}


TEST(LinearSolver, SolvesUnsymmetricSystems)
{
  check_solution("automatic", 3.);
  check_solution("iterative", 3.);
  check_solution("direct", 3.);
}


TEST(LinearSolver, AddsAPartOfRankOne)
{
  for (const std::string solver : {"automatic", "iterative", "direct"})
    for (const double skew : {0., 3.})
      check_rank_one(solver, skew);
}


TEST(LinearSolver, GoesDownhillOnNegativeCurvature)
{
  check_indefinite("automatic");
  check_indefinite("direct");
}


// Curvatures of both signs, and no diagonal that could be raised: conjugate
// gradients give up.
TEST(LinearSolver, FactorisesNoMoreThanIsAllowed)
{
  ChainProblem problem(n);
  problem.stiffness =
    [](const unsigned int i, const unsigned int j, const auto &) {
      return i != j && i / 2 == j / 2 ? 1. : 0.;
    };
  std::vector<double> values(n);
  for (unsigned int i = 0; i < n; ++i)
    values[i] = 1. + i % 2;
  const auto          b       = problem.vector_of(values);
  Equilibrium::Vector x       = problem.zero();
  const auto         &K       = problem.tangent(x, GrowthAt::current);
  unsigned int        ignored = 0;
  QuietTimer          timer;
  const auto          solve = [&](const std::string &solver) {
    LinearSolver linear_solver(parameters(solver), problem.linear, timer);
    linear_solver.solve(K, x, b, 1e-6, ignored);
    return defect(K, x, b);
  };
  EXPECT_THROW(solve("iterative"), StepFailed);
  EXPECT_LE(solve("automatic"), 1e-9);
  problem.linear.most_to_factorise = n;
  EXPECT_LE(solve("automatic"), 1e-9);
  problem.linear.most_to_factorise = n - 1;
  EXPECT_THROW(solve("automatic"), StepFailed);
  EXPECT_LE(solve("direct"), 1e-9);
}


TEST(LinearSolver, LeavesTheNullSpaceAlone)
{
  check_null_space("automatic");
  check_null_space("direct");
}


// Rows without any entry, as of splines that nothing fills: no factorisation
// has a pivot there.
TEST(LinearSolver, SolvesWithEmptyRows)
{
  for (const std::string solver : {"automatic", "iterative"})
    for (const double skew : {0., 3.})
      {
        SCOPED_TRACE(solver + (skew == 0. ? "" : ", unsymmetric"));
        unsigned int ignored = 0;
        QuietTimer   timer;
        ChainProblem problem = chain(0.5, skew);
        const auto   full    = problem.stiffness;
        const auto   empty   = [](const unsigned int i) { return i % 7 == 3; };
        problem.stiffness =
          [=](const unsigned int i, const unsigned int j, const auto &u) {
            return empty(i) || empty(j) ? 0. : full(i, j, u);
          };
        LinearSolver linear_solver(parameters(solver), problem.linear, timer);
        Equilibrium::Vector x      = problem.zero(), b;
        const auto         &K      = problem.tangent(x, GrowthAt::current);
        auto                values = random_values(4);
        for (unsigned int i = 0; i < n; ++i)
          if (empty(i))
            values[i] = 0.;
        b = problem.vector_of(values);
        linear_solver.solve(K, x, b, 1e-8, ignored);
        EXPECT_LE(defect(K, x, b), 1e-7);
      }
}


// A matrix whose incomplete factorisation is not positive though it is.
TEST(LinearSolver, DoesWithoutAFactorisation)
{
  unsigned int ignored = 0;
  QuietTimer   timer;
  ChainProblem problem(n);
  // The foundation is stiff, but weakened next to every fifth unknown until the
  // pivot is negative; the diagonal alone is a good preconditioner.
  problem.stiffness =
    [](const unsigned int i, const unsigned int j, const auto &) {
      return i == j ? (i % 5 == 0 ? 1e-12 : 1.) : (i / 5 == j / 5 ? 1e-7 : 0.);
    };
  LinearSolver linear_solver(parameters("iterative"), problem.linear, timer);
  Equilibrium::Vector x = problem.zero();
  const auto         &K = problem.tangent(x, GrowthAt::current);
  const auto          b = problem.vector_of(random_values(5));
  linear_solver.solve(K, x, b, 1e-6, ignored);
  EXPECT_TRUE(std::isfinite(x.l2_norm()));
  EXPECT_GT(x * b, 0.);
}


TEST(LinearSolver, FailsTogetherWhereNothingHelps)
{
  unsigned int ignored = 0;
  QuietTimer   timer;
  ChainProblem problem(n);
  problem.stiffness = [](auto, auto, auto &) { return 0.; };
  LinearSolver linear_solver(parameters("iterative"), problem.linear, timer);
  Equilibrium::Vector x = problem.zero();
  EXPECT_THROW(linear_solver.solve(problem.tangent(x, GrowthAt::current),
                                   x,
                                   problem.vector_of(random_values(3)),
                                   1e-6,
                                   ignored),
               StepFailed);
  EXPECT_GE(ignored, 1u); // work that came to nothing counts as well
}
