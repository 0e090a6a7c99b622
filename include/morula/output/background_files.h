// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_background_files_h
#define morula_output_background_files_h

#include <mpi.h>

#include <functional>
#include <future>

namespace Morula
{
  /**
   * Files that a thread of rank 0 writes while the run goes on. At most one lot
   * of them is in memory. All members are collective.
   */
  class BackgroundFiles
  {
  public:
    explicit BackgroundFiles(const MPI_Comm comm);

    /**
     * Begins to write, when the lot before is finished.
     * @param write writes the files; only rank 0 calls it. It must not
     *   communicate.
     * @param wait  finishes them, too
     * @throws std::runtime_error as finish(), also about the lot before
     */
    void
    start(std::function<void()> write, const bool wait);

    /** Whether there are files that are not finished. */
    bool
    pending() const
    {
      return is_pending;
    }

    /** Whether there are, and they are written, so that finish() need not wait.
     */
    bool
    written() const;

    /**
     * Waits for the files, if there are any.
     * @throws std::runtime_error on all ranks, with path and reason. The files
     *   are given up then.
     */
    void
    finish();

  private:
    const MPI_Comm    comm;
    bool              is_pending = false;
    std::future<void> thread; // on rank 0
  };
} // namespace Morula

#endif
