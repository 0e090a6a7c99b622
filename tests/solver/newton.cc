// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "solver/room.h"

constexpr unsigned int n = 12;

double
solution(const unsigned int i)
{
  return 1.5 * std::sin(1. + i);
}

/** Springs with stiffening ends, whose loads have the equilibrium u_i =
 *  solution(i); and a part @p skew that has no energy. */
ChainProblem
hardening(const double skew)
{
  ChainProblem problem(n);
  const auto   inner = [skew](const unsigned int         i,
                            const std::vector<double> &u) {
    double f = u[i] + u[i] * u[i] * u[i];
    if (i > 0)
      f += u[i] - u[i - 1] - skew * u[i - 1];
    if (i + 1 < n)
      f += u[i] - u[i + 1] + skew * u[i + 1];
    return f;
  };
  std::vector<double> loads, goal;
  for (unsigned int i = 0; i < n; ++i)
    goal.push_back(solution(i));
  for (unsigned int i = 0; i < n; ++i)
    loads.push_back(inner(i, goal));

  problem.force = [=](const unsigned int i, const std::vector<double> &u) {
    return inner(i, u) - loads[i];
  };
  problem.stiffness = [=](const unsigned int         i,
                          const unsigned int         j,
                          const std::vector<double> &u) {
    if (i != j)
      return -1. + (i < j ? skew : -skew);
    return 1. + 3. * u[i] * u[i] + (i > 0 ? 1. : 0.) + (i + 1 < n ? 1. : 0.);
  };
  if (skew == 0.)
    problem.energy = [=](const std::vector<double> &u) {
      double sum = 0.;
      for (unsigned int i = 0; i < n; ++i)
        {
          sum += 0.5 * u[i] * u[i] + 0.25 * std::pow(u[i], 4) - loads[i] * u[i];
          if (i + 1 < n)
            sum += 0.5 * std::pow(u[i] - u[i + 1], 2);
        }
      return sum;
    };
  problem.linear.symmetric = skew == 0.;
  return problem;
}

Outcome
solved(ChainProblem      &problem,
       const double       tolerance,
       const std::string &linear_solver = "automatic")
{
  const Outcome result = outcome(problem, tolerance, linear_solver);
  EXPECT_EQ(result.failure, "");
  return result;
}


TEST(Newton, FindsTheEquilibrium)
{
  for (const std::string linear_solver : {"automatic", "direct"})
    for (const double skew : {0., 0.4})
      {
        SCOPED_TRACE(linear_solver + (skew == 0. ? "" : ", without energy"));
        ChainProblem  problem = hardening(skew);
        const Outcome result  = solved(problem, 1e-11, linear_solver);
        for (unsigned int i = 0; i < n; ++i)
          EXPECT_NEAR(result.u[i], solution(i), 1e-9);
        EXPECT_LE(result.report.residual, 1e-11);
        if (linear_solver == "direct") // factorisations
          EXPECT_EQ(result.report.linear_iterations, problem.tangents.size());
        else
          EXPECT_GE(result.report.linear_iterations,
                    result.report.newton_iterations);
        EXPECT_LE(result.report.newton_iterations, 12u);
      }
}


// Near the solution each residual is of the order of the last one's square.
TEST(Newton, ConvergesQuadratically)
{
  ChainProblem problem  = hardening(0.);
  problem.linear.costly = false;
  solved(problem, 1e-12, "direct");
  const auto &norms = problem.residual_norms;
  ASSERT_GE(norms.size(), 5u);
  unsigned int n_quadratic = 0;
  for (std::size_t k = 0; k + 1 < norms.size(); ++k)
    if (norms[k] < 1. && norms[k] > 1e-7)
      {
        EXPECT_LE(norms[k + 1], 2. * norms[k] * norms[k] + 1e-12);
        ++n_quadratic;
      }
  EXPECT_GE(n_quadratic, 2u);
}


TEST(Newton, TakesOnlyTheFirstTangentAtTheOldGrowth)
{
  ChainProblem problem  = hardening(0.);
  problem.linear.costly = false;
  solved(problem, 1e-8);
  ASSERT_GE(problem.tangents.size(), 3u);
  EXPECT_EQ(problem.tangents[0], GrowthAt::previous);
  for (std::size_t k = 1; k < problem.tangents.size(); ++k)
    EXPECT_EQ(problem.tangents[k], GrowthAt::current);
}


TEST(Newton, KeepsACostlyTangentWhileTheResidualFalls)
{
  ONE_RANK_IS_ENOUGH();
  for (const std::string linear_solver : {"automatic", "direct"})
    for (const double skew : {0., 0.4})
      {
        SCOPED_TRACE(linear_solver + (skew == 0. ? "" : ", without energy"));
        ChainProblem dear = hardening(skew), cheap = hardening(skew);
        cheap.linear.costly = false;
        const Outcome all   = solved(cheap, 1e-11, linear_solver);
        const Outcome kept  = solved(dear, 1e-11, linear_solver);
        EXPECT_EQ(cheap.tangents.size(), all.report.newton_iterations);

        EXPECT_LT(dear.tangents.size(), cheap.tangents.size());
        for (unsigned int i = 0; i < n; ++i)
          EXPECT_NEAR(kept.u[i], all.u[i], 1e-10);
      }
}


// The first step would be an inversion. Half of it makes the residual sixteen
// times smaller, but its tangent was a bad one.
TEST(Newton, KeepsNoTangentWhoseStepWasShortened)
{
  ChainProblem problem = alike(
    n,
    [](double u) {
      return u < 1. ? 0.5 * u * u - 0.8 * u :
                      std::numeric_limits<double>::infinity();
    },
    [](double u) { return u - 0.8; },
    [](double u) { return u == 0. ? 0.8 / 1.5 : 1.; });
  const Outcome result = solved(problem, 1e-10, "direct");
  EXPECT_EQ(result.report.newton_iterations, 2u);
  EXPECT_EQ(problem.tangents.size(), 2u);
}


// Too stiff a tangent: each iteration leaves 0.19 of the error.
TEST(Newton, KeepsNoTangentInALongRow)
{
  ONE_RANK_IS_ENOUGH();
  ChainProblem problem = alike(
    n,
    [](double u) { return 0.5 * u * u - u; },
    [](double u) { return u - 1.; },
    [](double) { return 1. / 0.81; });
  const Outcome result = solved(problem, 1e-12, "direct");
  ASSERT_GT(result.report.newton_iterations, 12u);
  EXPECT_EQ(problem.tangents.size(), result.report.newton_iterations - 9);
}


TEST(Newton, DoesNothingAtEquilibrium)
{
  {
    ChainProblem problem = alike(
      n,
      [](double u) { return 0.5 * u * u; },
      [](double u) { return u; },
      [](double) { return 1.; });
    const Outcome result = solved(problem, 1e-6);
    EXPECT_EQ(result.report.newton_iterations, 0u);
    EXPECT_EQ(result.report.residual, 0.);
  }
  {
    // Forces far below those that count in the scene.
    ChainProblem problem = alike(
      n,
      [](double u) { return 0.5 * u * u - 1e-9 * u; },
      [](double u) { return u - 1e-9; },
      [](double) { return 1.; });
    problem.scales.small_force = 1.;
    EXPECT_EQ(solved(problem, 1e-6).report.newton_iterations, 0u);
    problem.scales.small_force = 1e-9;
    EXPECT_GT(solved(problem, 1e-6).report.newton_iterations, 0u);
  }
}


// A residual that counts as small leaves an error behind: Newton's method goes
// on until that is small as well, or the residual is nothing but rounding.
TEST(Newton, GoesOnUntilTheUnknownsHaveConverged)
{
  ONE_RANK_IS_ENOUGH();
  const auto error = [](const double length, unsigned int &iterations) {
    ChainProblem problem  = hardening(0.);
    problem.scales.length = length;
    problem.linear.costly = false;
    const Outcome result  = solved(problem, 1e-2, "direct");
    iterations            = result.report.newton_iterations;
    double largest        = 0.;
    for (unsigned int i = 0; i < n; ++i)
      largest = std::max(largest, std::abs(result.u[i] - solution(i)));
    return largest;
  };
  unsigned int at_once, later, latest;
  EXPECT_GT(error(1e3, at_once), 1e-4);
  EXPECT_LE(error(1e-2, later), 1e-4);
  EXPECT_LE(error(1e-30, latest), 1e-12);
  EXPECT_LT(at_once, later);
  EXPECT_LT(later, latest);
  EXPECT_LE(latest, at_once + 5u);
}


// The first full step would go far beyond the barrier at u = 1.
TEST(Newton, StepsBackFromInversion)
{
  ChainProblem problem = alike(
    n,
    [](double u) {
      return u < 1. ? -std::log(1. - u) - 20. * u :
                      std::numeric_limits<double>::infinity();
    },
    [](double u) { return 1. / (1. - u) - 20.; },
    [](double u) { return 1. / ((1. - u) * (1. - u)); });
  const Outcome result = solved(problem, 1e-8);
  for (const double u : result.u)
    EXPECT_NEAR(u, 0.95, 1e-8);
}


// A double well, started on the hill between: the tangent is negative.
TEST(Newton, GoesDownFromAHill)
{
  ChainProblem problem = alike(
    n,
    [](double u) { return std::pow(u * u - 1., 2) - 0.1 * u; },
    [](double u) { return 4. * u * (u * u - 1.) - 0.1; },
    [](double u) { return 12. * u * u - 4.; });
  const Outcome result = solved(problem, 1e-10);
  // Where one was indefinite none is kept.
  EXPECT_EQ(problem.tangents.size(), result.report.newton_iterations);
  for (const double u : result.u)
    {
      EXPECT_NEAR(4. * u * (u * u - 1.), 0.1, 1e-8);
      EXPECT_GT(u, 0.9);
    }
}


// It asks of states to which indefinite tangents have led, and ends where one
// is refused.
TEST(Newton, EndsWhereAStateIsRefused)
{
  QuietTimer             timer;
  NewtonReport           report;
  unsigned int           asked = 0;
  const SolverParameters parameters;
  const OnTheWay         check{[&](const Equilibrium::Vector &u) {
                         ++asked;
                         if (u.linfty_norm() > 0.1)
                           throw StepFailed("too far");
                       },
                               {}};
  ChainProblem           well = alike(
    n,
    [](double u) { return std::pow(u * u - 1., 2) - 0.1 * u; },
    [](double u) { return 4. * u * (u * u - 1.) - 0.1; },
    [](double u) { return 12. * u * u - 4.; });
  Equilibrium::Vector u = well.zero();
  try
    {
      solve(
        well, well.linear, well.scales, parameters, timer, u, report, check);
      FAIL() << "it must fail";
    }
  catch (const StepFailed &failure)
    {
      EXPECT_NE(std::string(failure.what()).find("too far"), std::string::npos);
    }
  EXPECT_GT(asked, 0u);
  ChainProblem stable = hardening(0.);
  asked               = 0;
  u                   = stable.zero();
  solve(
    stable, stable.linear, stable.scales, parameters, timer, u, report, check);
  EXPECT_EQ(asked, 0u);
}


TEST(Newton, FailsWithoutASolution)
{
  ONE_RANK_IS_ENOUGH();
  // The energy has no minimum.
  ChainProblem endless = alike(
    n,
    [](double u) { return -0.5 * u * u - u; },
    [](double u) { return -u - 1.; },
    [](double) { return -1.; });
  EXPECT_NE(outcome(endless, 1e-6).failure, "");

  ChainProblem inverted = alike(
    n,
    [](double) { return std::numeric_limits<double>::infinity(); },
    [](double) { return 1.; },
    [](double) { return 1.; });
  EXPECT_NE(outcome(inverted, 1e-6).failure, "");

  // Without energy: |R| has a minimum where R is not zero.
  ChainProblem stuck = alike(
    n,
    [](double) { return 0.; },
    [](double u) { return u * u - u + 1.; },
    [](double u) { return 2. * u - 1.; });
  stuck.linear.symmetric = false;
  EXPECT_NE(outcome(stuck, 1e-6).failure, "");
}


// Wherever the search looks, the body is inverted: it does not go on from one
// of these places.
TEST(Newton, EndsWithASearchThatFindsNothing)
{
  ChainProblem problem = alike(
    n,
    [](double u) {
      return u == 0. ? 0. : std::numeric_limits<double>::infinity();
    },
    [](double) { return -1.; },
    [](double) { return 1.; });
  const Outcome result = outcome(problem, SolverParameters().newton_tolerance);
  EXPECT_NE(result.failure, "");
  EXPECT_EQ(result.report.newton_iterations, 1u);
}


// NOX threw strings before Trilinos 14.2, and throws runtime errors since: the
// step has failed. Whatever else is thrown is none of Newton's business.
TEST(Newton, FailsWhereNoxGivesUp)
{
  const auto throws = [](const auto &what) {
    ChainProblem problem = hardening(0.);
    problem.stiffness    = [&what](const unsigned int,
                                const unsigned int,
                                const std::vector<double> &) -> double {
      throw what;
    };
    return problem;
  };
  const char *const        message = "NOX Error";
  const std::runtime_error error("NOX Error"), other("the disk is full");
  ChainProblem             before_14_2 = throws(message);
  EXPECT_NE(outcome(before_14_2, 1e-6).failure, "");
  ChainProblem since = throws(error);
  EXPECT_NE(outcome(since, 1e-6).failure, "");
  ChainProblem elsewhere = throws(other);
  try
    {
      outcome(elsewhere, 1e-6);
      FAIL() << "it must fail";
    }
  catch (const std::runtime_error &failure)
    {
      EXPECT_STREQ(failure.what(), other.what());
    }
}


// Downhill without end: the curvature is that of the diagonal itself.
TEST(Newton, ReportsNegativeCurvature)
{
  ONE_RANK_IS_ENOUGH();
  ChainProblem problem = alike(
    n,
    [](double u) { return -std::exp(u); },
    [](double u) { return -std::exp(u); },
    [](double u) { return -std::exp(u); });
  const Outcome result = outcome(problem, SolverParameters().newton_tolerance);
  EXPECT_NE(result.failure, "");
  EXPECT_NEAR(result.report.curvature, -1., 1e-9);
}


TEST(Newton, ReportsAddUp)
{
  QuietTimer       timer;
  SolverParameters parameters;
  NewtonReport     report;
  ChainProblem     problem   = hardening(0.);
  const auto       once_more = [&]() {
    Equilibrium::Vector u = problem.zero();
    solve(
      problem, problem.linear, problem.scales, parameters, timer, u, report);
  };
  once_more();
  const unsigned int once = report.newton_iterations;
  once_more();
  EXPECT_EQ(report.newton_iterations, 2 * once);
  EXPECT_LE(report.residual, parameters.newton_tolerance);
}


// A chain that may move as a whole, under loads that do not balance.
TEST(Newton, LeavesAnUnbalancedLoadOut)
{
  for (const std::string linear_solver : {"automatic", "direct"})
    {
      SCOPED_TRACE(linear_solver);
      ChainProblem problem(n);
      const auto   load = [](const unsigned int i) {
        return 1. + std::sin(2. * i);
      };
      problem.force = [&](const unsigned int i, const std::vector<double> &u) {
        return (i > 0 ? u[i] - u[i - 1] : 0.) +
               (i + 1 < n ? u[i] - u[i + 1] : 0.) - load(i);
      };
      problem.stiffness =
        [](const unsigned int i, const unsigned int j, auto &) {
          return i != j ? -1. : (i > 0) + (i + 1 < n);
        };
      problem.energy = [&](const std::vector<double> &u) {
        double sum = 0.;
        for (unsigned int i = 0; i < n; ++i)
          sum +=
            (i > 0 ? 0.5 * std::pow(u[i] - u[i - 1], 2) : 0.) - load(i) * u[i];
        return sum;
      };
      problem.linear.null_space.push_back(
        problem.vector_of(std::vector<double>(n, 1. / std::sqrt(1. * n))));
      const Outcome result = solved(problem, 1e-9, linear_solver);

      double mean = 0., sum = 0.;
      for (unsigned int i = 0; i < n; ++i)
        {
          mean += load(i) / n;
          sum += result.u[i];
        }
      EXPECT_NEAR(sum, 0., 1e-9);
      // The load less its mean is in equilibrium.
      for (unsigned int i = 0; i < n; ++i)
        EXPECT_NEAR(problem.force(i, result.u), -mean, 1e-7);
    }
}
