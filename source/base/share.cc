// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/share.h>

#include <deal.II/base/mpi.h>

namespace Morula
{
  std::pair<std::uint64_t, std::uint64_t>
  share(const std::uint64_t n, const MPI_Comm comm)
  {
    const std::uint64_t rank = dealii::Utilities::MPI::this_mpi_process(comm);
    const std::uint64_t n_ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
    // n % n_ranks * r / n_ranks spreads the rest evenly, and no product
    // overflows.
    const auto begin = [=](const std::uint64_t r) {
      return n / n_ranks * r + n % n_ranks * r / n_ranks;
    };
    return {begin(rank), begin(rank + 1)};
  }
} // namespace Morula
