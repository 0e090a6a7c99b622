// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_failure_h
#define morula_program_failure_h

#include <deal.II/base/mpi.h>

#include <string>

namespace Morula
{
  /**
   * Ends a failed run on all ranks. Each rank calls it when an exception has
   * left the run.
   *
   * If all ranks fail, the first one prints their messages to the standard
   * error, equal messages once, and the function returns the largest
   * @p exit_code, which main() returns. A rank that does not fail within a few
   * seconds would wait for the failed ones for ever. If there is one, every
   * failed rank prints its message and aborts all ranks with @p exit_code.
   */
  int
  end_all_ranks(const int          exit_code,
                const std::string &message,
                const MPI_Comm     comm);
} // namespace Morula

#endif
