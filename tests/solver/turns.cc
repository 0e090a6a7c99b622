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
    [&]() {
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
