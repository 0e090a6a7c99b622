// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_share_h
#define morula_base_share_h

#include <mpi.h>

#include <cstdint>
#include <utility>

namespace Morula
{
  /** This rank's share [begin, end) of the numbers 0...n-1: all ranks have
   * about as many. */
  std::pair<std::uint64_t, std::uint64_t>
  share(const std::uint64_t n, const MPI_Comm comm);
} // namespace Morula

#endif
