// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "common/mpi_counts.h"
#include "solver/room.h"

constexpr unsigned int n = 80;

const MPI_Comm comm = MPI_COMM_WORLD;

using Vector = Equilibrium::Vector;

/** Springs of different stiffness; @p weak of the foundation, anywhere. */
ChainProblem
chain(const double weak)
{
  ChainProblem problem(n);
  problem.stiffness =
    [=](const unsigned int i, const unsigned int j, const auto &) {
      const auto spring = [](const unsigned int k) {
        return 1. + std::sin(1. * k) * std::sin(1. * k);
      };
      if (i != j)
        return -spring(std::min(i, j));
      return (i == 17 ? weak : 0.01) + (i > 0 ? spring(i - 1) : 0.) +
             (i + 1 < n ? spring(i) : 0.);
    };
  return problem;
}

Vector
load(const ChainProblem &problem)
{
  std::vector<double> values(n);
  for (unsigned int i = 0; i < n; ++i)
    values[i] = std::cos(0.7 * i * i) + (i == 17 ? 3. : 0.);
  return problem.vector_of(values);
}

struct Result
{
  CgOutcome    outcome;
  unsigned int iterations = 0;
  double       needed     = 0.;
  Vector       x;
};

/** By the form for several ranks, or by the plain one. */
template <typename Preconditioner>
Result
solve_by(const bool            one_reduction,
         const ShiftedSystem  &system,
         const Preconditioner &P,
         const Vector         &b,
         const double          tolerance,
         const unsigned int    max_iterations = 500)
{
  Result     result;
  const auto run = [&](const auto &method) {
    result.x.reinit(b);
    result.outcome = method(system,
                            P,
                            result.x,
                            b,
                            tolerance,
                            max_iterations,
                            result.iterations,
                            result.needed);
  };
  if (one_reduction)
    run(one_reduction_an_iteration<Preconditioner>);
  else
    run(plain_conjugate_gradients<Preconditioner>);
  return result;
}

/** The system of a chain, and its diagonal as preconditioner. */
struct System
{
  explicit System(ChainProblem &problem)
    : K(problem.tangent(problem.zero(), GrowthAt::current))
    , b(load(problem))
    , P(jacobi(diagonal_magnitude(K, b), 0.))
  {}

  Result
  solve(const bool         one_reduction,
        const double       tolerance,
        const unsigned int max_iterations = 500) const
  {
    const std::vector<Vector> none;
    return solve_by(one_reduction,
                    ShiftedSystem{K, none, 0., {}},
                    P,
                    b,
                    tolerance,
                    max_iterations);
  }

  /** |K x - b| / |b| */
  double
  defect(const Vector &x) const
  {
    return Morula::defect(K, x, b) / b.l2_norm();
  }

  const Equilibrium::Matrix   &K;
  const Vector                 b;
  const DiagonalMatrix<Vector> P;
};

/** The largest one, of b's largest entry. */
double
difference(const Vector &a, const Vector &b)
{
  Vector d(a);
  d -= b;
  return d.linfty_norm() / b.linfty_norm();
}


TEST(ConjugateGradients, FormsAgree)
{
  ChainProblem problem = chain(0.01);
  const auto  &K       = problem.tangent(problem.zero(), GrowthAt::current);
  const Vector b       = load(problem);
  const auto   P       = OverlappingCholesky(K, {});
  const auto   m       = diagonal_magnitude(K, b);
  const auto   n1      = problem.vector_of(
    std::vector<double>(n, 1. / std::sqrt(1. * n))); // a motion
  const Equilibrium::RankOnes parts{{b, 0.1}, {n1, 0.2}};
  for (const double shift : {0., 0.1})
    for (const bool has_motion : {false, true})
      for (const auto &rank_ones : {parts, Equilibrium::RankOnes()})
        {
          const std::vector<Vector> motions(has_motion ? 1 : 0, n1);
          const ShiftedSystem       system{K, motions, shift, rank_ones};
          for (const double tolerance : {1e-1, 1e-4, 1e-10})
            {
              const Result plain =
                solve_by(false, system, jacobi(m, shift), b, tolerance);
              const Result other =
                solve_by(true, system, jacobi(m, shift), b, tolerance);
              EXPECT_EQ(other.outcome, CgOutcome::converged);
              EXPECT_EQ(other.iterations, plain.iterations);
              EXPECT_LE(difference(other.x, plain.x), 1e-10 + 0.01 * tolerance);
              const Result blockwise = solve_by(true, system, P, b, tolerance);
              EXPECT_EQ(blockwise.outcome, CgOutcome::converged);
              EXPECT_LE(difference(blockwise.x, plain.x),
                        tolerance < 1e-5 ? 1e-6 : 10.);
            }
        }
}


// The residual that is predicted is that of the solution.
TEST(ConjugateGradients, StopsAtTheTolerance)
{
  ChainProblem problem = chain(0.01);
  const System system(problem);
  for (const double tolerance : {0.3, 1e-2, 1e-5, 1e-8})
    {
      const Result whole = system.solve(true, tolerance);
      EXPECT_LE(system.defect(whole.x), tolerance);
      EXPECT_GT(system.defect(
                  system.solve(true, tolerance, whole.iterations - 1).x),
                tolerance);
    }
}


// Of an exact factor one step is enough, and the residual that is left is
// rounding.
TEST(ConjugateGradients, EndsAfterOneStepOfAnExactInverse)
{
  ChainProblem problem(n);
  problem.stiffness = [](const unsigned int i, const unsigned int j, auto &) {
    return i == j ? 1. + i : 0.;
  };
  const System system(problem);
  for (const double tolerance : {1e-2, 1e-6, 1e-12})
    {
      const Result result = system.solve(true, tolerance);
      EXPECT_EQ(result.outcome, CgOutcome::converged);
      EXPECT_EQ(result.iterations, 1u);
      EXPECT_LE(system.defect(result.x), 1e-12);
    }
}


TEST(ConjugateGradients, BothFormsMeetNegativeCurvature)
{
  // From far below zero to where the chain is just not stable any more.
  unsigned int n_negative = 0;
  for (const double weak : {-5., -1., -0.2, -0.14, -0.12, -0.1, -0.05, 0.01})
    {
      ChainProblem problem = chain(weak);
      const System system(problem);
      const Result plain = system.solve(false, 1e-8);
      const Result other = system.solve(true, 1e-8);
      EXPECT_EQ(other.outcome, plain.outcome) << weak;
      EXPECT_EQ(other.iterations, plain.iterations) << weak;
      EXPECT_NEAR(other.needed, plain.needed, 1e-6 * plain.needed) << weak;
      n_negative += plain.outcome == CgOutcome::negative_curvature;
    }
  EXPECT_GE(n_negative, 2u);
  EXPECT_LE(n_negative, 7u);
}


TEST(ConjugateGradients, OneReductionAndNoBarrierAnIteration)
{
  // Alone, a rank's block is the matrix: there is nothing to count.
  if (Utilities::MPI::n_mpi_processes(comm) == 1)
    return;
  ChainProblem problem = chain(0.01);
  const auto  &K       = problem.tangent(problem.zero(), GrowthAt::current);
  const Vector b       = load(problem);
  // With a raised diagonal, to take iterations enough.
  OverlappingCholesky::Parameters raised;
  raised.relative_diagonal = 3.;
  const OverlappingCholesky P(K, raised);
  const auto                J = jacobi(diagonal_magnitude(K, b), 0.);
  const auto                motion =
    problem.vector_of(std::vector<double>(n, 1. / std::sqrt(1. * n)));
  const Equilibrium::RankOnes parts{{load(problem), 2.}};
  constexpr unsigned int      few = 3, many = 13;

  const auto check = [&](const auto                  &preconditioner,
                         const std::vector<Vector>   &motions,
                         const Equilibrium::RankOnes &rank_ones,
                         const unsigned int           reductions) {
    for (const double shift : {0., 0.1})
      {
        const ShiftedSystem system{K, motions, shift, rank_ones};
        MpiCounts           counts[2];
        unsigned int        n_iterations[2];
        for (const unsigned int k : {0, 1})
          {
            const MpiCounts before = mpi_counts;
            n_iterations[k] =
              solve_by(true, system, preconditioner, b, 0., k == 0 ? few : many)
                .iterations;
            counts[k].reductions = mpi_counts.reductions - before.reductions;
            counts[k].barriers   = mpi_counts.barriers - before.barriers;
            counts[k].others     = mpi_counts.others - before.others;
          }
        EXPECT_GT(counts[0].reductions, 0u);
        EXPECT_EQ(counts[1].reductions - counts[0].reductions,
                  reductions * (n_iterations[1] - n_iterations[0]));
        EXPECT_GE(n_iterations[1], n_iterations[0] + 4);
        EXPECT_EQ(counts[1].barriers, counts[0].barriers);
        EXPECT_EQ(counts[1].others, counts[0].others);
      }
  };
  check(P, {}, {}, 1);
  check(J, {}, {}, 1);
  // What is outside the matrix takes another one.
  check(P, {motion}, {}, 2);
  check(P, {}, parts, 2);
  check(J, {motion}, parts, 2);
}
