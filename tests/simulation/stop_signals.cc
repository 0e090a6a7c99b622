// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// ranks: 1 3

#include "simulation/room.h"

struct sigaction
action_of(const int number)
{
  struct sigaction action{};
  sigaction(number, nullptr, &action);
  return action;
}

bool
is_last_rank()
{
  return this_rank() + 1 == number_of_ranks();
}


TEST(StopSignals, AllRanksHearOfTheSignalOfOne)
{
  for (const int number : {SIGINT, SIGTERM, SIGUSR1})
    {
      const StopSignals signals(MPI_COMM_WORLD);
      EXPECT_EQ(signals.received(), 0);
      if (is_last_rank())
        raise(number);
      EXPECT_EQ(signals.received(), number);
    }
}


TEST(StopSignals, TheSecondSignalActsAsEver)
{
  const StopSignals signals(MPI_COMM_WORLD);
  raise(SIGTERM);
  EXPECT_EQ(action_of(SIGTERM).sa_handler, SIG_DFL);
  EXPECT_NE(action_of(SIGINT).sa_handler, SIG_DFL);
}


TEST(StopSignals, LeaveThingsAsTheyWere)
{
  signal(SIGINT, SIG_IGN); // as nohup and shells do for what is in background
  {
    const StopSignals signals(MPI_COMM_WORLD);
    raise(SIGINT);
    EXPECT_EQ(signals.received(), 0);
  }
  EXPECT_EQ(action_of(SIGINT).sa_handler, SIG_IGN);
  signal(SIGINT, SIG_DFL);

  const auto before = action_of(SIGTERM).sa_handler;
  {
    const StopSignals signals(MPI_COMM_WORLD);
    EXPECT_NE(action_of(SIGTERM).sa_handler, before);
  }
  EXPECT_EQ(action_of(SIGTERM).sa_handler, before);
}
