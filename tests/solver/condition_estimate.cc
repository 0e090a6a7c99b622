// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "solver/room.h"

double
even_spring(const unsigned int)
{
  return 1.;
}

/** All eigenvalues of the scaled symmetric part in ascending order, by
 *  LAPACK. */
std::vector<double>
dense_eigenvalues(const ChainProblem &problem)
{
  const unsigned int       n = problem.n;
  LAPACKFullMatrix<double> matrix(n);
  const auto               K = [&](const unsigned int i, const unsigned int j) {
    return problem.stiffness(i, j, {});
  };
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = i == 0 ? 0 : i - 1; j < std::min(i + 2, n); ++j)
      matrix(i, j) =
        0.5 * (K(i, j) + K(j, i)) / std::sqrt(std::abs(K(i, i) * K(j, j)));
  matrix.set_property(LAPACKSupport::symmetric);
  FullMatrix<double>     vectors;
  dealii::Vector<double> values;
  matrix.compute_eigenvalues_symmetric(-1e3, 1e3, 1e-14, values, vectors);
  return {values.begin(), values.end()};
}

ConditionEstimate
estimate(ChainProblem &problem)
{
  return estimate_condition(problem, problem.linear, problem.zero());
}

void
check(ChainProblem &problem, const double smallest, const double largest)
{
  const ConditionEstimate found = estimate(problem);
  EXPECT_EQ(found.unknowns, problem.n);
  EXPECT_NEAR(found.smallest / smallest, 1., 1e-6);
  EXPECT_NEAR(found.largest / largest, 1., 1e-6);
  EXPECT_NEAR(found.condition() / (largest / smallest), 1., 2e-6);
  EXPECT_EQ(problem.tangents.back(), GrowthAt::previous);
}

/** Condition numbers from 3 to 10^8. */
TEST(ConditionEstimate, AgreesWithADenseComputation)
{
  for (const double foundation : {10., 1e-1, 1e-4, 1e-7})
    {
      SCOPED_TRACE(foundation);
      ChainProblem problem = chain_of_springs(60, foundation);
      const auto   values  = dense_eigenvalues(problem);
      check(problem, values.front(), values.back());
    }
}

/** A chain fixed at both ends: 1 -+ cos(pi/(n+1)). */
TEST(ConditionEstimate, AgreesWithAClosedForm)
{
  ONE_RANK_IS_ENOUGH();
  for (const unsigned int n : {10u, 100u, 1000u})
    {
      ChainProblem problem(n);
      problem.stiffness = [](const unsigned int i,
                             const unsigned int j,
                             const auto &) { return i == j ? 7. : -3.5; };
      const double c    = std::cos(numbers::PI / (n + 1));
      check(problem, 1. - c, 1. + c);
    }
}

/** Without foundation the chain as a whole is free to move. */
TEST(ConditionEstimate, LeavesOutWhatIsFree)
{
  for (const auto &spring : {even_spring, uneven_spring})
    {
      ChainProblem problem = chain_of_springs(40, 0., 0., spring);
      const auto   values  = dense_eigenvalues(problem);
      ASSERT_NEAR(values.front(), 0., 1e-14);

      const ConditionEstimate with = estimate(problem);
      EXPECT_GE(with.condition(), 1e12);

      problem.linear.null_space.push_back(
        problem.vector_of(std::vector<double>(40, 1. / std::sqrt(40.))));
      check(problem, values[1], values.back());
    }
}

TEST(ConditionEstimate, TakesTheSymmetricPart)
{
  ChainProblem problem = chain_of_springs(50, 0.01, 0.3);
  const auto   values  = dense_eigenvalues(problem);
  check(problem, values.front(), values.back());
}

TEST(ConditionEstimate, ShowsIndefiniteTangents)
{
  ChainProblem problem = chain_of_springs(50, -0.3, 0., even_spring);
  const auto   values  = dense_eigenvalues(problem);
  ASSERT_LT(values.front(), 0.);
  const ConditionEstimate found = estimate(problem);
  EXPECT_NEAR(found.smallest / values.front(), 1., 1e-6);
  EXPECT_NEAR(found.condition(),
              1. / std::numeric_limits<double>::epsilon(),
              1e-3 / std::numeric_limits<double>::epsilon());
}

/** An unknown without any stiffness, such as a spline that touches none of the
 *  body. */
TEST(ConditionEstimate, ShowsSingularTangents)
{
  ChainProblem problem(30);
  problem.stiffness =
    [](const unsigned int i, const unsigned int j, const auto &) {
      return i == j && i != 11 ? 1. + i : 0.;
    };
  const ConditionEstimate found = estimate(problem);
  EXPECT_NEAR(found.smallest, 0., 1e-14);
  EXPECT_GE(found.condition(), 1e14);
}
