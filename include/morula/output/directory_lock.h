// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_directory_lock_h
#define morula_output_directory_lock_h

#include <mpi.h>

#include <string>

namespace Morula
{
  /**
   * Keeps other runs out of a directory while this object lives. It holds a
   * lock of the system (flock) on the file `morula.lock` there, which names
   * process and host. The system releases the lock when the process ends, in
   * whatever way. Nobody locks the file of a killed run; the next run takes it
   * over.
   *
   * It is flock and not fcntl: a process loses its fcntl lock as soon as it
   * closes any descriptor of the file. On Linux' NFS both are locks of the
   * server, which hold between machines. On Lustre, flock needs the mount
   * option of that name. A file system without locks keeps no other run out;
   * reason_without_lock() says so.
   */
  class DirectoryLock
  {
  public:
    /**
     * Creates the directory if it does not exist, and locks it. Collective;
     * rank 0 holds the lock.
     * @throws InputError on all ranks, if another run holds the lock (the
     *   message names its process and host), or if the directory cannot be
     *   written
     */
    DirectoryLock(const std::string &directory, const MPI_Comm comm);

    /** Removes the file, unless another run's file has taken its place. */
    ~DirectoryLock();

    DirectoryLock(const DirectoryLock &) = delete;
    DirectoryLock &
    operator=(const DirectoryLock &) = delete;

    /** Why there is no lock; empty if there is one. Equal on all ranks. */
    const std::string &
    reason_without_lock() const
    {
      return reason_without_lock_;
    }

    /**
     * Refuses a directory that another run has locked, and touches nothing.
     * One rank calls it, before work that would be in vain.
     * @throws InputError
     */
    static void
    check_free(const std::string &directory);

  private:
    void
    take(const std::string &directory);

    std::string path;
    int         descriptor = -1;
    std::string reason_without_lock_;
  };
} // namespace Morula

#endif
