// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_global_order_h
#define morula_base_global_order_h

#include <morula/base/send_records.h>

#include <algorithm>
#include <cstdint>
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

  /**
   * Where each of this rank's @p keys stands in the order of all ranks' keys.
   * The place does not depend on the number of ranks or on which rank has which
   * key. Equal keys have the same place. Each rank sorts all keys, which are
   * few beside the points of a rank: those of cells that divide in a step, or
   * of patches. Collective.
   * @tparam Key trivially copyable, with operator<
   */
  template <typename Key>
  GlobalOrder
  global_order(const std::vector<Key> &keys, const MPI_Comm comm)
  {
    std::vector<Key> all;
    for (const auto &of_rank : gather_everywhere(keys, comm))
      all.insert(all.end(), of_rank.begin(), of_rank.end());
    std::sort(all.begin(), all.end());
    GlobalOrder order;
    order.n_keys = all.size();
    order.places.reserve(keys.size());
    for (const Key &key : keys)
      order.places.push_back(std::lower_bound(all.begin(), all.end(), key) -
                             all.begin());
    return order;
  }
} // namespace Morula

#endif
