// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_of_all_ranks_h
#define morula_seeding_of_all_ranks_h

#include <deal.II/base/mpi.templates.h>

#include <vector>

namespace Morula
{
  /** What all ranks have, in the order of the ranks, which is that of founders'
   *  and patches' numbers. Collective. */
  template <typename T>
  std::vector<T>
  of_all_ranks(const std::vector<T> &mine, const MPI_Comm comm)
  {
    std::vector<T> all;
    for (const auto &part : dealii::Utilities::MPI::all_gather(comm, mine))
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }
} // namespace Morula

#endif
