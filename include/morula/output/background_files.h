// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_background_files_h
#define morula_output_background_files_h

#include <morula/output/pending_file.h>

#include <mpi.h>

#include <future>
#include <memory>
#include <vector>

namespace Morula
{
  /**
   * Files that are written while the run goes on: a thread of each rank writes
   * its parts, without messages. At most one lot of them is in memory. All
   * members are collective.
   */
  class BackgroundFiles
  {
  public:
    explicit BackgroundFiles(const MPI_Comm comm);

    /**
     * Begins to write, when the lot before is finished.
     * @param files without those that are nullptr, which are written already
     * @param wait  finishes them, too
     * @throws std::runtime_error on all ranks, with path and reason, also those
     *   of the lot before
     */
    void
    start(std::vector<std::unique_ptr<PendingFile>> files, const bool wait);

    /** Whether there are files that are not finished. */
    bool
    pending() const;

    /** Whether there are, and all ranks have written them, so that finish()
     * need not wait. */
    bool
    written() const;

    /**
     * Waits for the files, if there are any, and replaces the old ones.
     * @throws std::runtime_error on all ranks, with path and reason. The files
     *   are given up then.
     */
    void
    finish();

  private:
    const MPI_Comm                            comm;
    std::vector<std::unique_ptr<PendingFile>> files;
    // Behind the files, as its end waits for the thread that writes them.
    std::future<void> thread;
  };
} // namespace Morula

#endif
