// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/grid/parts_on_ranks.h>

#include <deal.II/base/mpi.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <array>
#include <numeric>

namespace Morula
{
  using namespace dealii;

  namespace
  {
    /** A rank, its part, and the part of the rank that tells of it. */
    using Pair = std::array<unsigned int, 3>;

    std::vector<Pair>
    pairs_of(const PartsOnRanks::Seen                              &seen,
             const std::function<unsigned int(const unsigned int)> &part_of,
             const MPI_Comm                                         comm)
    {
      std::vector<Pair> pairs;
      // part_of() is asked on the owner, who knows its own part of the grid
      // cell. A pair is told once, however many grid cells two parts share.
      for (const auto &[rank, list] : send_records(seen, comm))
        for (const PartsOnRanks::GridCellOfPart &grid_cell : list)
          pairs.push_back({{rank, grid_cell.part, part_of(grid_cell.number)}});
      std::sort(pairs.begin(), pairs.end());
      pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
      return pairs;
    }
  } // namespace


  PartsOnRanks::PartsOnRanks(
    const std::vector<unsigned int>                       &lowest,
    const Seen                                            &seen,
    const std::function<unsigned int(const unsigned int)> &part_of,
    const MPI_Comm                                         comm)
  {
    // Every rank gathers the lowest grid cells of all parts of all ranks, and
    // all pairs of parts that share a grid cell. Both are short: tissue has few
    // parts. Each rank then joins the same sets, so that all of them find the
    // same wholes, without a further message. A whole is named by its lowest
    // grid cell; their order is independent of the number of ranks.
    const auto all_lowest = gather_everywhere(lowest, comm);
    const auto all_pairs =
      gather_everywhere(pairs_of(seen, part_of, comm), comm);
    std::vector<unsigned int> first(1, 0); // part of each rank
    std::vector<unsigned int> lowest_of;
    for (const auto &list : all_lowest)
      {
        first.push_back(first.back() + list.size());
        lowest_of.insert(lowest_of.end(), list.begin(), list.end());
      }

    std::vector<unsigned int> depth(lowest_of.size(), 0),
      parent(lowest_of.size());
    std::iota(parent.begin(), parent.end(), 0u);
    boost::disjoint_sets<unsigned int *, unsigned int *> sets(depth.data(),
                                                              parent.data());
    // Part numbers become numbers over all ranks by first[rank].
    for (std::size_t rank = 0; rank < all_pairs.size(); ++rank)
      for (const auto &[other, their_part, part] : all_pairs[rank])
        sets.union_set(first[rank] + part, first[other] + their_part);

    // The lowest grid cell of a whole stands at its root.
    for (unsigned int part = 0; part < lowest_of.size(); ++part)
      {
        unsigned int &low = lowest_of[sets.find_set(part)];
        low               = std::min(low, lowest_of[part]);
      }
    for (unsigned int part = 0; part < lowest_of.size(); ++part)
      if (sets.find_set(part) == part)
        lowest_.push_back(lowest_of[part]);
    std::sort(lowest_.begin(), lowest_.end());
    // What this rank needs in the end is the whole of each of its own parts.
    const unsigned int begin = first[Utilities::MPI::this_mpi_process(comm)];
    for (unsigned int part = begin; part < begin + lowest.size(); ++part)
      wholes.push_back(std::lower_bound(lowest_.begin(),
                                        lowest_.end(),
                                        lowest_of[sets.find_set(part)]) -
                       lowest_.begin());
  }


  unsigned int
  PartsOnRanks::whole_of(const unsigned int part) const
  {
    return wholes[part];
  }


  const std::vector<unsigned int> &
  PartsOnRanks::lowest() const
  {
    return lowest_;
  }
} // namespace Morula
