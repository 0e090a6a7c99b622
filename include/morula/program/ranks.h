// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_ranks_h
#define morula_program_ranks_h

#include <deal.II/base/mpi.h>

#include <string>

namespace Morula
{
  /**
   * Tells Open MPI by environment variables how to start, before MPI_Init.
   * Other MPIs do not know them, and the user's own go first.
   *
   * ROMIO is preferred to Open MPI's own way to files. That one gives each open
   * file a semaphore of the whole machine, named by the file's name without its
   * directory. A run that is killed as it opens its snapshot leaves the
   * semaphore locked, and all later runs on that machine would wait for it for
   * ever.
   *
   * Its library hwloc does not look for graphics cards on X servers. It would
   * ask the displays 0 to 9, and a server that ends meanwhile ends the program
   * ("XIO: fatal IO error").
   *
   * A single rank that no launcher has started gets no daemon, which only new
   * processes would need, no directories for messages, and no search for
   * networks. That is half of the time to start (doc/performance.md, The start
   * of the program).
   */
  void
  set_up_open_mpi();

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
