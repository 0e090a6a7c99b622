// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
// ranks: 1 3

#include "base/room.h"

using namespace dealii;

const MPI_Comm comm = MPI_COMM_WORLD;

bool
is_last()
{
  return this_rank() + 1 == number_of_ranks();
}

/** Where the action fails on the last rank, all fail with its exception. */
template <typename Exception>
void
check_all_throw()
{
  try
    {
      everywhere(comm, []() {
        if (is_last())
          throw Exception("on rank " + std::to_string(this_rank()));
      });
      ADD_FAILURE() << "rank " << this_rank() << " threw nothing";
    }
  catch (const std::exception &error)
    {
      EXPECT_EQ(typeid(error), typeid(Exception));
      EXPECT_EQ(error.what(),
                "on rank " + std::to_string(number_of_ranks() - 1));
    }
}


TEST(Everywhere, RunsOnAllRanks)
{
  unsigned int runs = 0;
  everywhere(comm, [&runs]() { ++runs; });
  EXPECT_EQ(runs, 1u);
}


TEST(Everywhere, AllRanksThrowWhatOneThrew)
{
  check_all_throw<InputError>();
  check_all_throw<StepFailed>();
  check_all_throw<std::runtime_error>();
}


TEST(Everywhere, TheLowestRankCounts)
{
  EXPECT_THROW(everywhere(comm,
                          []() {
                            if (this_rank() == 0)
                              throw StepFailed("of the first");
                            throw InputError("of the others");
                          }),
               StepFailed);
}
