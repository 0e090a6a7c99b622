// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "solver/room.h"

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

SolverParameters
parameters(const std::string &solver)
{
  SolverParameters result;
  result.linear_solver = solver;
  return result;
}

/** The tangent of a chain at rest, and a solver of its linear systems. */
struct System
{
  System(ChainProblem &problem, const std::string &solver)
    : linear_solver(parameters(solver), problem.linear, timer)
    , x(problem.zero())
    , K(problem.tangent(x, GrowthAt::current))
  {}

  /** From zero on. @return the iterations */
  unsigned int
  solve(const Equilibrium::Vector   &b,
        const double                 tolerance,
        const bool                   same_matrix = false,
        const Equilibrium::RankOnes &rank_ones   = {})
  {
    x                         = 0.;
    unsigned int n_iterations = 0;
    linear_solver.solve(
      K, x, b, tolerance, n_iterations, same_matrix, rank_ones);
    return n_iterations;
  }

  /** |K x - b| / |b| */
  double
  defect(const Equilibrium::Vector &b) const
  {
    return Morula::defect(K, x, b) / b.l2_norm();
  }

  QuietTimer                 timer;
  LinearSolver               linear_solver;
  Equilibrium::Vector        x;
  const Equilibrium::Matrix &K;
};

/** The distance of two vectors, relative to the second one. */
double
error(Equilibrium::Vector found, const Equilibrium::Vector &exact)
{
  found -= exact;
  return found.l2_norm() / exact.l2_norm();
}

const std::vector<std::string> all_solvers = {"automatic",
                                              "iterative",
                                              "direct"};


TEST(LinearSolver, SolvesSymmetricAndUnsymmetricSystems)
{
  for (const std::string &solver : all_solvers)
    for (const double skew : {0., 3.})
      {
        SCOPED_TRACE(solver);
        ChainProblem        problem = chain_of_springs(n, 0.5, skew);
        System              system(problem, solver);
        const auto          solution = problem.vector_of(random_values(1));
        Equilibrium::Vector b(solution);
        system.K.vmult(b, solution);
        const unsigned int n_iterations = system.solve(b, 1e-10);
        EXPECT_GE(n_iterations, 1u);
        EXPECT_LE(system.defect(b), 1e-9);
        EXPECT_LE(error(system.x, solution), 1e-7);

        // Of the same matrix the direct solver has a factor.
        const Equilibrium::Vector first(system.x);
        EXPECT_EQ(system.solve(b, 1e-10, true),
                  solver == "direct" ? 0 : n_iterations);
        EXPECT_LE(error(system.x, first), 1e-14);

        // A loose tolerance is no more work, and the preconditioner serves for
        // another matrix.
        EXPECT_LE(system.solve(b, 1e-2), n_iterations);
        EXPECT_LE(system.defect(b), 2e-2);
        const auto spring = problem.stiffness;
        problem.stiffness =
          [&](const unsigned int i, const unsigned int j, const auto &u) {
            return spring(i, j, u) + (i == j ? 0.3 * (i % 4) : 0.);
          };
        problem.tangent(solution, GrowthAt::current);
        system.solve(b, 1e-8);
        EXPECT_LE(system.defect(b), 1e-7);
      }
}


// Parts that fill the matrix, far stiffer than the rest.
TEST(LinearSolver, AddsPartsOfRankOne)
{
  for (const std::string &solver : all_solvers)
    for (const double skew : {0., 3.})
      {
        SCOPED_TRACE(solver);
        ChainProblem problem  = chain_of_springs(n, 0.5, skew);
        const auto   solution = problem.vector_of(random_values(1));
        System       system(problem, solver);
        const Equilibrium::RankOnes parts{
          {problem.vector_of(random_values(6)), 1e3},
          {problem.vector_of(random_values(7)), 2e2}};
        Equilibrium::Vector b(solution);
        system.K.vmult(b, solution);
        for (const auto &part : parts)
          b.add(part.factor * (part.b * solution), part.b);
        system.solve(b, 1e-11, false, parts);
        EXPECT_LE(error(system.x, solution), 1e-5);
      }
}


// A diagonal of both signs; a shift turns all of it positive.
TEST(LinearSolver, GoesDownhillOnNegativeCurvature)
{
  ONE_RANK_IS_ENOUGH();
  for (const std::string solver : {"automatic", "direct"})
    {
      SCOPED_TRACE(solver);
      ChainProblem problem(n);
      problem.stiffness =
        [](const unsigned int i, const unsigned int j, auto &) {
          const double entry = i % 3 == 0 ? -1. - 0.01 * i : 2. + 0.1 * i;
          return i == j ? entry : 0.;
        };
      System system(problem, solver);
      for (unsigned int seed = 1; seed <= 5; ++seed)
        {
          // Mostly where the curvature is negative.
          auto values = random_values(seed);
          for (unsigned int i = 0; i < n; ++i)
            if (i % 3 != 0)
              values[i] *= 0.05;
          const auto b = problem.vector_of(values);
          for (const bool same_matrix : {false, true})
            {
              system.solve(b, 1e-6, same_matrix);
              EXPECT_TRUE(std::isfinite(system.x.l2_norm()));
              EXPECT_GT(system.x * b, 0.); // b = -R: downhill
              EXPECT_TRUE(system.linear_solver.has_shifted());
            }
        }
    }
}


// No residual is below zero: GMRES gives up.
TEST(LinearSolver, FactorisesNoMoreThanIsAllowed)
{
  ONE_RANK_IS_ENOUGH();
  ChainProblem problem = chain_of_springs(n, 1., 0.3);
  const auto   b       = problem.vector_of(random_values(1));
  const auto   solve   = [&](const std::string &solver) {
    System system(problem, solver);
    system.solve(b, -1.);
    return system.defect(b);
  };
  EXPECT_THROW(solve("iterative"), StepFailed);
  EXPECT_LE(solve("automatic"), 1e-9);
  problem.linear.most_to_factorise = n;
  EXPECT_LE(solve("automatic"), 1e-9);
  problem.linear.most_to_factorise = n - 1;
  EXPECT_THROW(solve("automatic"), StepFailed);
  EXPECT_LE(solve("direct"), 1e-9);
}


// Free to move as a whole: the loads' mean does not count.
TEST(LinearSolver, LeavesTheNullSpaceAlone)
{
  for (const std::string solver : {"automatic", "direct"})
    {
      SCOPED_TRACE(solver);
      ChainProblem problem = chain_of_springs(n, 0.);
      const auto   motion =
        problem.vector_of(std::vector<double>(n, 1. / std::sqrt(1. * n)));
      problem.linear.null_space.push_back(motion);
      System     system(problem, solver);
      const auto b        = problem.vector_of(random_values(2));
      auto       balanced = b;
      balanced.add(-(b * motion), motion);
      system.solve(b, 1e-9);
      const Equilibrium::Vector first(system.x);
      EXPECT_NEAR(first * motion, 0., 1e-9 * first.l2_norm());
      EXPECT_FALSE(system.linear_solver.has_shifted());
      // The direct solver shifts the diagonal a little.
      EXPECT_LE(system.defect(balanced), solver == "direct" ? 1e-3 : 1e-8);
      system.solve(b, 1e-9, true);
      EXPECT_EQ(error(system.x, first), 0.);
    }
}


// Rows without any entry, as of splines that nothing fills: no factorisation
// has a pivot there.
TEST(LinearSolver, SolvesWithEmptyRows)
{
  for (const std::string solver : {"automatic", "iterative"})
    for (const double skew : {0., 3.})
      {
        SCOPED_TRACE(solver + (skew == 0. ? "" : ", unsymmetric"));
        ChainProblem problem = chain_of_springs(n, 0.5, skew);
        const auto   full    = problem.stiffness;
        const auto   empty   = [](const unsigned int i) { return i % 7 == 3; };
        problem.stiffness =
          [=](const unsigned int i, const unsigned int j, const auto &u) {
            return empty(i) || empty(j) ? 0. : full(i, j, u);
          };
        auto values = random_values(4);
        for (unsigned int i = 0; i < n; ++i)
          if (empty(i))
            values[i] = 0.;
        const auto b = problem.vector_of(values);
        System     system(problem, solver);
        system.solve(b, 1e-8);
        EXPECT_LE(system.defect(b), 1e-7);
      }
}


// A matrix whose incomplete factorisation is not positive though it is: the
// foundation is stiff, but weakened next to every fifth unknown until the pivot
// is negative; the diagonal alone is a good preconditioner.
TEST(LinearSolver, DoesWithoutAFactorisation)
{
  ChainProblem problem(n);
  problem.stiffness =
    [](const unsigned int i, const unsigned int j, const auto &) {
      return i == j ? (i % 5 == 0 ? 1e-12 : 1.) : (i / 5 == j / 5 ? 1e-7 : 0.);
    };
  System     system(problem, "iterative");
  const auto b = problem.vector_of(random_values(5));
  system.solve(b, 1e-6);
  EXPECT_TRUE(std::isfinite(system.x.l2_norm()));
  EXPECT_GT(system.x * b, 0.);
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
