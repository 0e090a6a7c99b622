// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_background_files_h
#define morula_output_background_files_h

#include <mpi.h>

#include <functional>
#include <future>
#include <memory>
#include <vector>

namespace Morula
{
  /** A file that has begun, as what is left to do. All throw a
   *  std::runtime_error with path and reason. */
  struct PendingFile
  {
    /** Writes this rank's part, or makes what will be written. No
     *  communication: another thread does it. */
    std::function<void()> write;
    /** Replaces the old file, when all ranks have written. Collective. */
    std::function<void()> commit;
    /** Where the file has another stage: begins it, when all ranks have done
     * this one, which then has no commit(). Collective. */
    std::function<std::unique_ptr<PendingFile>()> next;
  };

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
    pending() const
    {
      return !files.empty();
    }

    /** Whether there are, and all ranks have written them, so that finish()
     * need not wait. Begins the next stage of files that have one.
     * @throws as finish() */
    bool
    written();

    /**
     * Waits for the files, if there are any, and replaces the old ones.
     * @throws std::runtime_error on all ranks, with path and reason. The files
     *   are given up then.
     */
    void
    finish();

  private:
    void
    launch(const std::launch policy);
    /** Waits for the thread. @return whether files have another stage, which
     *  has begun now */
    bool
    end_stage();

    const MPI_Comm                            comm;
    std::vector<std::unique_ptr<PendingFile>> files;
    // Behind the files, as its end waits for the thread that writes them.
    std::future<void> thread;
  };
} // namespace Morula

#endif
