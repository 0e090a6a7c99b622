// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_appended_csv_h
#define morula_output_appended_csv_h

#include <morula/output/digest.h>
#include <morula/output/posix_file.h>

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace Morula
{
  /** A table as far as it goes, for a snapshot: what is kept of it. */
  struct TableExtent
  {
    std::uint64_t n_rows = 0; // below the header
    std::uint64_t digest = 0; // of header and rows; known to rank 0
  };

  /**
   * A CSV file that grows by rows during a run. Rank 0 writes; all members are
   * collective and throw on all ranks alike. A row that was torn by a crash is
   * never read: a resumed run cuts the file behind the rows it knows of.
   */
  class AppendedCsv
  {
  public:
    /**
     * Starts a new file with its header.
     * @throws std::runtime_error with path and reason
     */
    AppendedCsv(const std::string              &path,
                const std::vector<std::string> &names,
                const MPI_Comm                  comm);

    /**
     * Continues a file behind the rows that are to be @p kept; what follows is
     * cut.
     * @throws InputError if the file is missing, has another header, fewer
     * rows, or rows with another digest
     */
    AppendedCsv(const std::string              &path,
                const std::vector<std::string> &names,
                const TableExtent              &kept,
                const MPI_Comm                  comm);

    /**
     * Refuses what the second constructor would, and changes nothing.
     * @throws InputError
     */
    static void
    check(const std::string              &path,
          const std::vector<std::string> &names,
          const TableExtent              &kept,
          const MPI_Comm                  comm);

    /**
     * Appends rank 0's @p rows, complete lines; they have left the program on
     * return.
     * @throws std::runtime_error with path and reason, also if somebody has
     *   deleted the file
     */
    void
    append(const std::string &rows);

    /** Forces the rows to the disk: before a snapshot that counts them. */
    void
    sync();

    /** To be stored in a snapshot. */
    TableExtent
    extent() const
    {
      return {n_rows, digest.value()};
    }

  private:
    MPI_Comm                   comm;
    std::uint64_t              n_rows = 0;
    Digest                     digest; // of the file so far, on rank 0
    std::unique_ptr<PosixFile> file;   // on rank 0
  };
} // namespace Morula

#endif
