// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_global_order_h
#define morula_base_global_order_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

namespace Morula
{
  /** Where a rank's keys stand among those of all ranks. */
  struct GlobalOrder
  {
    /** For each of this rank's keys, in their order: how many keys of all ranks
     *  are smaller. */
    std::vector<std::uint64_t> places;
    std::uint64_t              n_keys = 0; // of all ranks
  };

  namespace Implementation
  {
    /** Largest number of keys that a rank shows to all others. */
    constexpr std::size_t n_samples = 32;

    /** At most n_samples of @p sorted keys, evenly spread; all keys if there
     *  are no more. */
    template <typename Key>
    std::vector<Key>
    samples_of(const std::vector<Key> &sorted)
    {
      if (sorted.size() <= n_samples)
        return sorted;
      std::vector<Key> samples;
      for (std::size_t s = 0; s < n_samples; ++s)
        samples.push_back(
          sorted[(2 * s + 1) * sorted.size() / (2 * n_samples)]);
      return samples;
    }

    /** Keys that cut the order of all keys into about equal parts, one for each
     *  rank: rank r orders the keys from splitter r - 1 up to splitter r. A
     *  sample counts as many keys as its rank has per sample. */
    template <typename Key>
    std::vector<Key>
    splitters(const std::vector<std::vector<Key>> &samples,
              const std::vector<std::uint64_t>    &n_keys)
    {
      std::vector<std::pair<Key, double>> weighted;
      for (std::size_t rank = 0; rank < samples.size(); ++rank)
        for (const Key &key : samples[rank])
          weighted.emplace_back(key, 1. * n_keys[rank] / samples[rank].size());
      std::sort(weighted.begin(),
                weighted.end(),
                [](const auto &a, const auto &b) { return a.first < b.first; });
      const double part =
        std::accumulate(n_keys.begin(), n_keys.end(), 0.) / samples.size();
      std::vector<Key> result;
      double           sum = 0.;
      for (const auto &[key, weight] : weighted)
        {
          sum += weight;
          while (result.size() + 1 < samples.size() &&
                 sum > (result.size() + 1) * part)
            result.push_back(key);
        }
      return result;
    }

    /** How many of @p sorted keys are smaller than each of @p keys. */
    template <typename Key>
    std::vector<std::uint64_t>
    places_in(const std::vector<Key> &sorted, const std::vector<Key> &keys)
    {
      std::vector<std::uint64_t> places;
      places.reserve(keys.size());
      for (const Key &key : keys)
        places.push_back(std::lower_bound(sorted.begin(), sorted.end(), key) -
                         sorted.begin());
      return places;
    }

    /** All keys of the parts, sorted. */
    template <typename Key>
    std::vector<Key>
    sorted_union(const std::vector<std::vector<Key>> &parts)
    {
      std::vector<Key> all;
      for (const auto &part : parts)
        all.insert(all.end(), part.begin(), part.end());
      std::sort(all.begin(), all.end());
      return all;
    }

    /** Places of the keys that each rank has sent here, among those of all
     *  ranks' buckets. Collective. */
    template <typename Key>
    std::map<unsigned int, std::vector<std::uint64_t>>
    places_in_bucket(const std::map<unsigned int, std::vector<Key>> &received,
                     const MPI_Comm                                  comm)
    {
      std::vector<std::vector<Key>> parts;
      for (const auto &[rank, keys] : received)
        parts.push_back(keys);
      const std::vector<Key> bucket = sorted_union(parts);

      const std::uint64_t n_own  = bucket.size();
      std::uint64_t       before = 0; // stays on rank 0
      const int           error =
        MPI_Exscan(&n_own, &before, 1, MPI_UINT64_T, MPI_SUM, comm);
      AssertThrowMPI(error);

      std::map<unsigned int, std::vector<std::uint64_t>> answers;
      for (const auto &[rank, keys] : received)
        {
          auto &places = answers[rank] = places_in(bucket, keys);
          for (std::uint64_t &place : places)
            place += before;
        }
      return answers;
    }
  } // namespace Implementation

  /**
   * Where each of this rank's @p keys stands in the order of all ranks' keys.
   * The place does not depend on the number of ranks or on which rank has which
   * key. Equal keys have the same place. Collective.
   *
   * A sample sort: no rank ever holds more than about its share of the keys.
   * Each rank shows at most 32 samples to the others. The samples decide which
   * rank orders which interval; its keys go there, and the places come back. If
   * no rank has more than 32 keys, all keys are shown and none needs to be
   * sent.
   * @tparam Key trivially copyable, with operator< and Boost's serialize()
   */
  template <typename Key>
  GlobalOrder
  global_order(const std::vector<Key> &keys, const MPI_Comm comm)
  {
    using namespace dealii;
    using namespace Implementation;

    const auto n_keys =
      Utilities::MPI::all_gather(comm, std::uint64_t(keys.size()));
    GlobalOrder result;
    result.n_keys =
      std::accumulate(n_keys.begin(), n_keys.end(), std::uint64_t(0));
    if (result.n_keys == 0)
      return result;

    std::vector<Key> sorted(keys);
    std::sort(sorted.begin(), sorted.end());
    if (n_keys.size() == 1)
      {
        result.places = places_in(sorted, keys);
        return result;
      }
    const auto samples = Utilities::MPI::all_gather(comm, samples_of(sorted));
    if (*std::max_element(n_keys.begin(), n_keys.end()) <= n_samples)
      {
        result.places = places_in(sorted_union(samples), keys);
        return result;
      }

    const auto limits = splitters(samples, n_keys);
    std::map<unsigned int, std::vector<Key>>         sent;
    std::map<unsigned int, std::vector<std::size_t>> numbers; // of those sent
    for (std::size_t k = 0; k < keys.size(); ++k)
      {
        const unsigned int rank =
          std::upper_bound(limits.begin(), limits.end(), keys[k]) -
          limits.begin();
        sent[rank].push_back(keys[k]);
        numbers[rank].push_back(k);
      }
    const auto answers = Utilities::MPI::some_to_some(
      comm,
      places_in_bucket<Key>(Utilities::MPI::some_to_some(comm, sent), comm));
    result.places.resize(keys.size());
    for (const auto &[rank, places] : answers)
      for (std::size_t k = 0; k < places.size(); ++k)
        result.places[numbers.at(rank)[k]] = places[k];
    return result;
  }
} // namespace Morula

#endif
