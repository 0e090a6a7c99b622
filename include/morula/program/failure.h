// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_failure_h
#define morula_program_failure_h

#include <deal.II/base/mpi.h>

#include <string>

namespace Morula
{
  /**
   * Ends a failed run on all ranks; to be called where an exception has left
   * the run. If all ranks fail, the first prints what they have to say to the
   * standard error, equal messages once, and the function returns the largest
   * @p exit_code, for main() to return. If some ranks have not failed within a
   * few seconds, they would wait for the others for ever: every rank that has
   * failed prints, and everything is aborted with @p exit_code.
   */
  int
  end_of_all_ranks(const int          exit_code,
                   const std::string &message,
                   const MPI_Comm     comm);
} // namespace Morula

#endif
