// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_run_lock_h
#define morula_output_run_lock_h

#include <mpi.h>

#include <string>

namespace Morula
{
  /**
   * Keeps other runs out of a directory while it lives: a lock of the system
   * (flock) on the file `morula.lock` there, which names process and host. The
   * system releases the lock when the process ends, in whatever way. A file
   * that a killed run has left is held by nobody, and is taken over.
   *
   * flock, as fcntl's locks go when the process closes any descriptor of the
   * file. On Linux' NFS both are locks of the server, which hold between
   * machines; on Lustre flock asks for the mount option of that name. Where
   * the file system knows no locks, nothing keeps another run out; complaint()
   * says so.
   */
  class RunLock
  {
  public:
    /**
     * Creates the directory if need be, and takes it. Collective; rank 0 holds
     * the lock.
     * @throws InputError, on all ranks, if another run holds it, with its
     *   process and host, or if the directory cannot be written
     */
    RunLock(const std::string &directory, const MPI_Comm comm);

    /** Removes the file, unless it is another one by now. */
    ~RunLock();

    RunLock(const RunLock &) = delete;
    RunLock &
    operator=(const RunLock &) = delete;

    /** Why there is no lock; empty if there is one. The same on all ranks. */
    const std::string &
    complaint() const
    {
      return complaint_;
    }

    /**
     * Refuses a directory that another run holds, and touches nothing. For one
     * rank, before work that would be in vain.
     * @throws InputError
     */
    static void
    check_free(const std::string &directory);

  private:
    void
    take(const std::string &directory);

    std::string path;
    int         descriptor = -1;
    std::string complaint_;
  };
} // namespace Morula

#endif
