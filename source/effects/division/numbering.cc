// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/division/numbering.h>

#include <deal.II/base/mpi.h>

#include <boost/serialization/utility.hpp>

#include <algorithm>
#include <utility>

namespace Morula
{
  std::vector<types::particle_index>
  number_daughters(const std::vector<DivisionEvent> &events,
                   types::particle_index            &next_id,
                   const MPI_Comm                    comm)
  {
    // Most steps of a small tissue have no division on any rank: then there is
    // nothing to exchange.
    if (Utilities::MPI::max(events.size(), comm) == 0)
      return {};

    using TimeAndMother = std::pair<double, types::particle_index>;
    std::vector<TimeAndMother> own;
    own.reserve(events.size());
    for (const DivisionEvent &event : events)
      own.emplace_back(event.time, event.mother);

    std::vector<TimeAndMother> all;
    for (const auto &of_rank : Utilities::MPI::all_gather(comm, own))
      all.insert(all.end(), of_rank.begin(), of_rank.end());
    std::sort(all.begin(), all.end());

    std::vector<types::particle_index> first_daughters;
    first_daughters.reserve(own.size());
    for (const TimeAndMother &event : own)
      first_daughters.push_back(
        next_id +
        2 * (std::lower_bound(all.begin(), all.end(), event) - all.begin()));

    next_id += 2 * all.size();
    return first_daughters;
  }
} // namespace Morula
