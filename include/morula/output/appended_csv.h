// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_appended_csv_h
#define morula_output_appended_csv_h

#include <morula/output/digest.h>
#include <morula/output/output_file.h>

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <string>

namespace Morula
{
  /** How much of a table stays when a run is resumed from a snapshot. */
  struct TableExtent
  {
    std::uint64_t n_rows = 0; // below the header
    std::uint64_t digest = 0; // of header and rows; only on rank 0
  };

  /**
   * A CSV file to which rows are appended during a run. All members are
   * collective and throw on all ranks alike. A crash may leave incomplete rows
   * at the end; they are never read, since a resumed run cuts the file behind
   * the rows that the snapshot knows of.
   */
  class AppendedCsv
  {
  public:
    /**
     * Starts a new file with its header, a complete line.
     * @throws std::runtime_error with path and reason
     */
    AppendedCsv(const std::string &path,
                const std::string &header,
                const MPI_Comm     comm);

    /**
     * Continues a file: keeps the rows that @p kept names, and cuts what
     * follows.
     * @throws InputError if the file is missing, or has another header, fewer
     * rows, or rows with another digest
     */
    AppendedCsv(const std::string &path,
                const std::string &header,
                const TableExtent &kept,
                const MPI_Comm     comm);

    /**
     * Throws what the second constructor would throw, and changes nothing.
     * @throws InputError
     */
    static void
    check(const std::string &path,
          const std::string &header,
          const TableExtent &kept,
          const MPI_Comm     comm);

    /**
     * Appends rank 0's @p rows, which are complete lines. On return the system
     * has them.
     * @throws std::runtime_error with path and reason, e.g. if somebody has
     *   deleted the file
     */
    void
    append(const std::string &rows);

    /** Forces the rows to the disk. Needed before a snapshot counts them. */
    void
    sync();

    /** What a snapshot stores. */
    TableExtent
    extent() const
    {
      return {n_rows, digest.value()};
    }

  private:
    MPI_Comm                    comm;
    std::uint64_t               n_rows = 0;
    Digest                      digest; // of the file so far, on rank 0
    std::unique_ptr<OutputFile> file;   // on rank 0
  };
} // namespace Morula

#endif
