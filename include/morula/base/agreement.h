// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_agreement_h
#define morula_base_agreement_h

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

namespace Morula
{
  /**
   * Runs @p action on every rank. If it throws on any rank, every rank throws
   * with the message of the lowest rank that failed. So no rank waits for one
   * that is gone. The action must not communicate. Collective.
   * @throws InputError, StepFailed if the lowest failing rank threw one
   * @throws std::runtime_error for every other exception
   */
  void
  everywhere(const MPI_Comm comm, const std::function<void()> &action);

  /** As everywhere(), for an @p action that only rank 0 runs. */
  void
  on_root(const MPI_Comm comm, const std::function<void()> &action);


  /** This rank's share [begin, end) of the numbers 0...n-1: all ranks have
   * about as many. */
  std::pair<std::uint64_t, std::uint64_t>
  share(const std::uint64_t n, const MPI_Comm comm);


  /** Writes a message to the terminal and into log.txt. To be called on all
   *  ranks; rank 0 writes. */
  using Announce = std::function<void(const std::string &text)>;
} // namespace Morula

#endif
