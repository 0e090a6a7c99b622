// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_log_h
#define morula_output_log_h

#include <morula/output/output_file.h>

#include <mpi.h>

#include <memory>
#include <string>

namespace Morula
{
  /** log.txt. Rank 0 writes it line by line. */
  class Log
  {
  public:
    /**
     * @param resume continue an existing file instead of starting a new one
     * @throws std::runtime_error, on all ranks, with path and reason
     */
    Log(const std::string &path, const bool resume, const MPI_Comm comm);

    /**
     * Appends @p text, of one or more lines, and a newline. Collective.
     * @throws std::runtime_error, on all ranks, with path and reason
     */
    void
    write(const std::string &text);

    /**
     * The same, not collective, for use after an exception. Does nothing if the
     * log cannot be written, and on other ranks than 0.
     */
    void
    write_if_possible(const std::string &text) noexcept;

  private:
    MPI_Comm                   comm;
    std::unique_ptr<OutputFile> file; // on rank 0
  };
} // namespace Morula

#endif
