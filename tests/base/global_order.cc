// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "base/room.h"

using namespace dealii;

const MPI_Comm comm = MPI_COMM_WORLD;

struct Event
{
  double       time;
  unsigned int id;

  friend bool
  operator<(const Event &a, const Event &b)
  {
    return a.time < b.time || (a.time == b.time && a.id < b.id);
  }
};

/** Compares with the order of all keys, gathered and sorted. */
template <typename Key>
void
expect_as_gathered(const std::vector<Key> &keys)
{
  std::vector<Key> all;
  for (const auto &part : gather_everywhere(keys, comm))
    all.insert(all.end(), part.begin(), part.end());
  std::stable_sort(all.begin(), all.end());

  const GlobalOrder order = global_order(keys, comm);
  EXPECT_EQ(order.n_keys, all.size());
  ASSERT_EQ(order.places.size(), keys.size());
  for (std::size_t k = 0; k < keys.size(); ++k)
    {
      std::uint64_t n_smaller = 0;
      while (n_smaller < all.size() && all[n_smaller] < keys[k])
        ++n_smaller;
      EXPECT_EQ(order.places[k], n_smaller) << "key " << k;
    }
}

/** Times of which many are equal, unless @p n_times is large. */
std::vector<Event>
random_events(const unsigned int n, const unsigned int n_times)
{
  std::mt19937       generator(5 + this_rank());
  std::vector<Event> events;
  const unsigned int n_ranks = number_of_ranks();
  for (unsigned int i = 0; i < n; ++i)
    events.push_back({(generator() % n_times) / 7., i * n_ranks + this_rank()});
  std::shuffle(events.begin(), events.end(), generator);
  return events;
}


TEST(GlobalOrder, FewKeysManyKeysAndEqualTimes)
{
  for (const auto &[n, n_times] :
       std::vector<std::pair<unsigned int, unsigned int>>{{0, 5},
                                                          {1, 5},
                                                          {2, 5},
                                                          {31, 5},
                                                          {32, 5},
                                                          {33, 1000000},
                                                          {100, 1000000},
                                                          {1500, 1000000},
                                                          {700, 1},
                                                          {700, 4}})
    expect_as_gathered(random_events(n, n_times));
}


TEST(GlobalOrder, EqualKeys)
{
  expect_as_gathered(std::vector<unsigned int>(300, 8));
  std::vector<unsigned int> keys;
  for (unsigned int i = 0; i < 300; ++i)
    keys.push_back(i % 3);
  expect_as_gathered(keys);
}


TEST(GlobalOrder, SomeRanksHaveNone)
{
  for (const unsigned int n : {3u, 500u})
    {
      expect_as_gathered(this_rank() == 0 ? random_events(n, 50) :
                                            std::vector<Event>());
      expect_as_gathered(this_rank() == 1 ? random_events(n, 50) :
                                            std::vector<Event>());
      expect_as_gathered(this_rank() == 2 ? random_events(n, 50) :
                                            random_events(n / 100, 50));
    }
}


// Ranks' keys that do not mix, in falling order.
TEST(GlobalOrder, SeparateKeys)
{
  std::vector<double> keys;
  for (unsigned int i = 0; i < 400; ++i)
    keys.push_back(std::sqrt(400. - i) - 1000. * this_rank());
  expect_as_gathered(keys);
}
