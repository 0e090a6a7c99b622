// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_available_memory_h
#define morula_base_available_memory_h

#include <mpi.h>

#include <cstdint>
#include <string>

namespace Morula
{
  /**
   * Bytes that this machine can still give to processes like this one: what
   * Linux calls available, which files that are kept in memory do not lessen,
   * but no more than the process's control groups (of a container or a batch
   * job) leave. 0 if the system does not tell.
   * @param root of the file system, for tests
   */
  std::uint64_t
  available_memory(const std::string &root = "/");

  /** Whether any machine has less left than its ranks of @p comm have taken so
   *  far. Collective. */
  bool
  memory_is_short(const MPI_Comm comm);
} // namespace Morula

#endif
