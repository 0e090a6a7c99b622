// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "solver/room.h"

/** Asks for so many further turns. */
class Wish : public TurnParticipant
{
public:
  explicit Wish(const unsigned int n)
    : n(n)
  {}

  bool
  renew(const Equilibrium::Vector &) override
  {
    ++n_asked;
    return n_asked <= n;
  }

  std::string
  unfinished() const override
  {
    return "a wish is left";
  }

  const unsigned int n;
  unsigned int       n_asked = 0;
};

/** Counts its solutions, and remembers when it was told that it goes on. */
struct Count : public ChainProblem
{
  Count()
    : ChainProblem(2)
  {}

  void
  use_growth_at_end() override
  {
    ++n_goes_on;
  }

  unsigned int n_solved = 0, n_goes_on = 0;
};

void
balance(Count &problem, std::vector<Wish *> wishes, NewtonReport &report)
{
  balance_in_turns(
    problem,
    std::vector<TurnParticipant *>(wishes.begin(), wishes.end()),
    [&](const Renewal &) {
      ++problem.n_solved;
      return Equilibrium::Evaluation();
    },
    problem.zero(),
    report);
}


TEST(Turns, OneIsEnoughWithoutParticipants)
{
  Count        problem;
  NewtonReport report;
  balance(problem, {}, report);
  EXPECT_EQ(problem.n_solved, 1u);
  EXPECT_EQ(problem.n_goes_on, 0u);
  EXPECT_EQ(report.turns, 1u);
}


// Each is asked after each turn, also where another one needs a turn anyway.
TEST(Turns, GoOnUntilNobodyNeedsOne)
{
  Count        problem;
  NewtonReport report;
  Wish         two(2), four(4);
  balance(problem, {&two, &four}, report);
  EXPECT_EQ(problem.n_solved, 5u);
  EXPECT_EQ(problem.n_goes_on, 4u);
  EXPECT_EQ(two.n_asked, 5u);
  EXPECT_EQ(report.turns, 5u);
  EXPECT_EQ(report.place.turn, 5u);
}


TEST(Turns, FailWithWhatIsUnfinished)
{
  Count        problem;
  NewtonReport report;
  Wish         never(1000);
  try
    {
      balance(problem, {&never}, report);
      FAIL();
    }
  catch (const StepFailed &failure)
    {
      EXPECT_EQ(std::string(failure.what()), "a wish is left");
    }
  EXPECT_EQ(report.turns, 20u);
}


/** Loads q = u/20 of unknowns, which are held fixed while u is sought. */
class Follower : public TurnParticipant
{
public:
  Follower(const ChainProblem &problem, const bool early)
    : problem(problem)
    , early(early)
    , q(problem.n, 0.)
  {}

  bool
  renew(const Equilibrium::Vector &u) override
  {
    double change = 0.;
    for (unsigned int i = 0; i < problem.n; ++i)
      {
        const double now = problem.gathered(u)[i] / 20.;
        change           = std::max(change, std::abs(now - q[i]));
        q[i]             = now;
      }
    return change > 1e-6;
  }

  bool
  renews_early() const override
  {
    return early;
  }

  std::string
  unfinished() const override
  {
    return "it does not settle";
  }

  const ChainProblem &problem;
  const bool          early;
  std::vector<double> q;
};

// Both ways lead to the same state; the short one has fewer iterations, and one
// tangent for more of them.
TEST(Turns, AreShortWhereThatIsAllowed)
{
  std::vector<NewtonReport> reports;
  std::vector<std::size_t>  n_tangents;
  for (const bool early : {false, true})
    {
      ChainProblem problem(6);
      Follower     follower(problem, early);
      problem.force = [&](const unsigned int i, const auto &u) {
        return u[i] + 0.02 * std::pow(u[i], 3) - 1. - i - follower.q[i];
      };
      problem.stiffness =
        [](const unsigned int i, const unsigned int j, const auto &u) {
          return i == j ? 1. + 0.06 * u[i] * u[i] : 0.;
        };
      problem.linear.symmetric = false;
      QuietTimer          timer;
      Equilibrium::Vector u      = problem.zero();
      NewtonReport       &report = reports.emplace_back();
      problem.scales.length      = 10.;
      balance_in_turns(
        problem,
        {&follower},
        [&](const Renewal &renew) {
          return solve(problem,
                       problem.linear,
                       problem.scales,
                       SolverParameters(),
                       timer,
                       u,
                       report,
                       {{}, renew});
        },
        u,
        report);
      n_tangents.push_back(problem.tangents.size());
      const std::vector<double> values = problem.gathered(u);
      for (unsigned int i = 0; i < problem.n; ++i)
        EXPECT_NEAR(0.95 * values[i] + 0.02 * std::pow(values[i], 3),
                    1. + i,
                    1e-5);
    }
  EXPECT_LT(reports[1].newton_iterations, reports[0].newton_iterations);
  EXPECT_LT(n_tangents[1], n_tangents[0]);
  EXPECT_GE(reports[1].turns, 3u);
}
