// ranks: 1 2 4
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/conjugate_gradients.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/linear_problem.h"
#include "common/mpi_counts.h"

using namespace Morula;

namespace
{
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
  solve(const bool            one_reduction,
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

  /** The largest one, of b's largest entry. */
  double
  difference(const Vector &a, const Vector &b)
  {
    Vector d(a);
    d -= b;
    return d.linfty_norm() / b.linfty_norm();
  }
} // namespace


TEST(Halo, AddsBackWhatItFetches)
{
  const ChainProblem problem(n);
  const IndexSet    &own = problem.owned;
  IndexSet           others(n); // every third
  for (unsigned int i = 0; i < n; i += 3)
    others.add_index(i);
  others.subtract_set(own);
  others.compress();
  const Halo          halo(own, others, comm);
  std::vector<double> mine, theirs(others.n_elements());
  for (const auto i : own)
    mine.push_back(100. + i);
  halo.fetch(mine.data(), theirs.data());
  for (unsigned int k = 0; k < theirs.size(); ++k)
    EXPECT_EQ(theirs[k], 100. + others.nth_index_in_set(k));
  halo.add_back(theirs.data(), mine.data());
  for (const double value : theirs)
    EXPECT_EQ(value, 0.);
  // All other ranks have sent back one in three.
  const unsigned int n_others = Utilities::MPI::n_mpi_processes(comm) - 1;
  for (unsigned int k = 0; k < mine.size(); ++k)
    {
      const auto i = own.nth_index_in_set(k);
      EXPECT_EQ(mine[k], (100. + i) * (i % 3 == 0 ? 1 + n_others : 1));
    }
}


TEST(ConjugateGradients, FormsAgree)
{
  ChainProblem      problem = chain(0.01);
  const auto       &K = problem.tangent(problem.zero(), GrowthAt::current);
  const HaloProduct product(K, 1, true);
  const Vector      b  = load(problem);
  const auto        P  = OverlappingCholesky(K, 1, {});
  const auto        m  = diagonal_magnitude(K, b);
  const auto        n1 = problem.vector_of(
    std::vector<double>(n, 1. / std::sqrt(1. * n))); // a motion
  const Equilibrium::RankOne part{b, 0.1};
  for (const double shift : {0., 0.1})
    for (const bool has_motion : {false, true})
      for (const auto *const rank_one : {&part, (decltype(&part))nullptr})
        {
          const std::vector<Vector> motions(has_motion ? 1 : 0, n1);
          const ShiftedSystem       system{product, motions, shift, rank_one};
          for (const double tolerance : {1e-1, 1e-4, 1e-10})
            {
              const Result plain =
                solve(false, system, Jacobi(m, shift), b, tolerance);
              const Result other =
                solve(true, system, Jacobi(m, shift), b, tolerance);
              EXPECT_EQ(other.outcome, CgOutcome::converged);
              EXPECT_EQ(other.iterations, plain.iterations);
              EXPECT_LE(difference(other.x, plain.x), 1e-10 + 0.01 * tolerance);
              const Result blockwise = solve(true, system, P, b, tolerance);
              EXPECT_EQ(blockwise.outcome, CgOutcome::converged);
              EXPECT_LE(difference(blockwise.x, plain.x),
                        tolerance < 1e-5 ? 1e-6 : 10.);
            }
        }
}


// The residual that is predicted is that of the solution.
TEST(ConjugateGradients, StopsAtTheTolerance)
{
  ChainProblem      problem = chain(0.01);
  const auto       &K = problem.tangent(problem.zero(), GrowthAt::current);
  const HaloProduct product(K, 1, true);
  const Vector      b = load(problem);
  const Jacobi      P(diagonal_magnitude(K, b), 0.);
  const std::vector<Vector> none;
  for (const double tolerance : {0.3, 1e-2, 1e-5, 1e-8})
    for (const bool one_less : {false, true})
      {
        const ShiftedSystem system{product, none, 0.};
        unsigned int        most = 500;
        if (one_less)
          most = solve(true, system, P, b, tolerance).iterations - 1;
        const Vector x = solve(true, system, P, b, tolerance, most).x;
        Vector       r(b);
        EXPECT_EQ(K.residual(r, x, b) > tolerance * b.l2_norm(), one_less)
          << tolerance;
      }
}


// Of an exact factor one step is enough, and the residual that is left is
// rounding.
TEST(ConjugateGradients, EndsAfterOneStepOfAnExactInverse)
{
  ChainProblem problem(n);
  problem.stiffness   = [](const unsigned int i,
                         const unsigned int j,
                         const auto &) { return i == j ? 1. + i : 0.; };
  const auto       &K = problem.tangent(problem.zero(), GrowthAt::current);
  const HaloProduct product(K, 1, true);
  const Vector      b = load(problem);
  const std::vector<Vector> none;
  const ShiftedSystem       system{product, none, 0.};
  const Jacobi              P(diagonal_magnitude(K, b), 0.);
  for (const double tolerance : {1e-2, 1e-6, 1e-12})
    {
      const Result result = solve(true, system, P, b, tolerance);
      EXPECT_EQ(result.outcome, CgOutcome::converged);
      EXPECT_EQ(result.iterations, 1u);
      Vector r(b);
      EXPECT_LE(K.residual(r, result.x, b), 1e-12 * b.l2_norm());
    }
}


TEST(ConjugateGradients, BothFormsMeetNegativeCurvature)
{
  // From far below zero to where the chain is just not stable any more.
  unsigned int n_negative = 0;
  for (const double weak : {-5., -1., -0.2, -0.14, -0.12, -0.1, -0.05, 0.01})
    {
      ChainProblem      problem = chain(weak);
      const auto       &K = problem.tangent(problem.zero(), GrowthAt::current);
      const HaloProduct product(K, 1, true);
      const Vector      b = load(problem);
      const std::vector<Vector> none;
      const ShiftedSystem       system{product, none, 0.};
      const Jacobi              P(diagonal_magnitude(K, b), 0.);
      const Result              plain = solve(false, system, P, b, 1e-8);
      const Result              other = solve(true, system, P, b, 1e-8);
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
  ChainProblem      problem = chain(0.01);
  const auto       &K = problem.tangent(problem.zero(), GrowthAt::current);
  const HaloProduct product(K, 1, true);
  const Vector      b = load(problem);
  // With a raised diagonal, to take iterations enough.
  OverlappingCholesky::Parameters raised;
  raised.relative_diagonal = 3.;
  const OverlappingCholesky P(K, 1, raised);
  const Jacobi              J(diagonal_magnitude(K, b), 0.);
  const auto                motion =
    problem.vector_of(std::vector<double>(n, 1. / std::sqrt(1. * n)));
  const Equilibrium::RankOne part{load(problem), 2.};
  constexpr unsigned int     few = 3, many = 13;

  const auto check = [&](const auto                 &preconditioner,
                         const std::vector<Vector>  &motions,
                         const Equilibrium::RankOne *rank_one,
                         const unsigned int          reductions) {
    for (const double shift : {0., 0.1})
      {
        const ShiftedSystem system{product, motions, shift, rank_one};
        MpiCounts           counts[2];
        unsigned int        n_iterations[2];
        for (const unsigned int k : {0, 1})
          {
            const MpiCounts before = mpi_counts;
            n_iterations[k] =
              solve(true, system, preconditioner, b, 0., k == 0 ? few : many)
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
  check(P, {}, nullptr, 1);
  check(J, {}, nullptr, 1);
  // What is outside the matrix takes another one.
  check(P, {motion}, nullptr, 2);
  check(P, {}, &part, 2);
  check(J, {motion}, &part, 2);
}
