// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_open_mpi_h
#define morula_program_open_mpi_h

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
} // namespace Morula

#endif
