// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
// ranks: 1 3

#include "program/room.h"

/** Number of times that @p part occurs in @p text. */
unsigned int
occurrences(const std::string &text, const std::string &part)
{
  unsigned int n = 0;
  for (auto i = text.find(part); i != std::string::npos;
       i      = text.find(part, i + 1))
    ++n;
  return n;
}


TEST(Failure, IsPrintedOnceByTheFirstRank)
{
  testing::internal::CaptureStderr();
  EXPECT_EQ(end_all_ranks(1, "no grid", MPI_COMM_WORLD), 1);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(text, this_rank() == 0 ? "morula: no grid\n" : "");
}


TEST(Failure, ShowsWhatOtherRanksHaveToSay)
{
  const unsigned int last    = number_of_ranks() - 1;
  const bool         is_last = this_rank() == last;
  testing::internal::CaptureStderr();
  EXPECT_EQ(end_all_ranks(is_last ? 2 : 1,
                          is_last ? "the cause" : "a consequence",
                          MPI_COMM_WORLD),
            2);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(occurrences(text, "the cause"), this_rank() == 0 ? 1u : 0u);
  EXPECT_EQ(occurrences(text, "a consequence"),
            this_rank() == 0 && last > 0 ? 1u : 0u);
}


TEST(Failure, ShowsBeginningAndEndOfLongMessages)
{
  testing::internal::CaptureStderr();
  end_all_ranks(1,
                "the key" + std::string(9999, 'a') + "the remedy",
                MPI_COMM_WORLD);
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(occurrences(text, "the key"), this_rank() == 0 ? 1u : 0u);
  EXPECT_EQ(occurrences(text, "the remedy"), this_rank() == 0 ? 1u : 0u);
  EXPECT_LT(text.size(), 3000u);
}
