// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  const MPI_Comm comm = MPI_COMM_WORLD;

  /** Of events known to all ranks, those that @p owner gives to this rank. */
  template <typename Owner>
  std::vector<DivisionEvent>
  own(const std::vector<DivisionEvent> &all, const Owner &owner)
  {
    const unsigned int n_ranks = Utilities::MPI::n_mpi_processes(comm);
    const unsigned int rank    = Utilities::MPI::this_mpi_process(comm);

    std::vector<DivisionEvent> events;
    for (unsigned int i = 0; i < all.size(); ++i)
      if (owner(i) % n_ranks == rank)
        events.push_back(all[i]);
    return events;
  }

  /** Checks the numbers that this rank's events get. */
  void
  expect_numbers(
    const std::vector<DivisionEvent>                             &events,
    const std::map<types::particle_index, types::particle_index> &first,
    const types::particle_index                                   n_divisions)
  {
    types::particle_index next_id = 100;
    const auto            ids     = number_daughters(events, next_id, comm);
    ASSERT_EQ(ids.size(), events.size());
    for (unsigned int i = 0; i < events.size(); ++i)
      EXPECT_EQ(ids[i], first.at(events[i].mother));
    EXPECT_EQ(next_id, 100 + 2 * n_divisions);
  }
} // namespace


TEST(Numbering, ByTimeThenMother)
{
  const std::vector<DivisionEvent> all = {
    {0.30, 4}, {0.10, 9}, {0.20, 7}, {0.20, 1}, {0.25, 0}, {0.20, 3}};
  expect_numbers(own(all, [](const unsigned int i) { return i; }),
                 {{9, 100}, {1, 102}, {3, 104}, {7, 106}, {0, 108}, {4, 110}},
                 6);
}


TEST(Numbering, OneRankHasAllEvents)
{
  const std::vector<DivisionEvent> all = {{2., 5}, {1., 6}};
  expect_numbers(own(all, [](const unsigned int) { return 1; }),
                 {{6, 100}, {5, 102}},
                 2);
}
