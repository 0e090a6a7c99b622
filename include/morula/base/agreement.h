// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_agreement_h
#define morula_base_agreement_h

#include <mpi.h>

#include <functional>

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
} // namespace Morula

#endif
