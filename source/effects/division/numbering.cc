// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/global_order.h>
#include <morula/effects/division/numbering.h>

namespace Morula
{
  std::vector<types::particle_index>
  number_daughters(const std::vector<DivisionEvent> &events,
                   types::particle_index            &next_id,
                   const MPI_Comm                    comm)
  {
    // The places of this rank's events among those of all ranks say which pairs
    // of ids they get. All ranks advance the next free id alike.
    const GlobalOrder order = global_order(events, comm);

    std::vector<types::particle_index> first_daughters;
    first_daughters.reserve(events.size());
    for (const std::uint64_t place : order.places)
      first_daughters.push_back(next_id + 2 * place);
    next_id += 2 * order.n_keys;
    return first_daughters;
  }
} // namespace Morula
