// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_directory_h
#define morula_output_directory_h

#include <mpi.h>

#include <string>
#include <vector>

namespace Morula
{
  /** Name of a file in a series: `cells`, 7, `vtu` give `cells-0007.vtu`. */
  std::string
  numbered_file(const std::string &stem,
                const unsigned int number,
                const std::string &extension);

  /**
   * Checks that a run can write into the directory, or create it. Touches
   * nothing.
   * @throws InputError if the path is no directory or cannot be written
   */
  void
  check_directory(const std::string &directory);

  /** Creates the directory unless it exists.
   *  @throws InputError as check_directory() */
  void
  create_directory(const std::string &directory);

  /** What a run writes about itself into its directory. */
  struct RunSetup
  {
    std::string scene_file;
    /** The text of a .prm file with all keys. */
    std::string parameters;
    /** Files that the scene reads. */
    std::vector<std::string> inputs;
    /** Whether to replace any run, not only one of the same scene file. */
    bool replace = false;
  };

  /**
   * Refuses to replace a run whose loss would matter: a run of another scene
   * file, an unfinished one, or one that took more than an hour. Refuses also a
   * directory that holds files with Morula's names, but no run of Morula.
   * Touches nothing. One rank calls it.
   * @param replace accept any run of Morula
   * @throws InputError
   */
  void
  check_replaceable(const std::string &directory,
                    const std::string &scene_file,
                    const bool         replace);

  /**
   * Makes the directory ready for a new run: creates it, writes parameters.prm,
   * and removes the other files of the old run (those with names that Morula
   * gives, no others). Collective.
   * @throws InputError on all ranks, as check_directory() and
   *   check_replaceable() do, or if one of the inputs would be removed
   */
  void
  prepare_directory(const std::string &directory,
                    const RunSetup    &run,
                    const MPI_Comm     comm);

  /**
   * Makes the directory ready to resume a run: writes parameters.prm, and
   * removes the numbered files from @p first_number on, since they were written
   * after the snapshot. Collective; throws as prepare_directory().
   */
  void
  prepare_resume(const std::string &directory,
                 const RunSetup    &run,
                 const unsigned int first_number,
                 const MPI_Comm     comm);

  /** Writes into parameters.prm that the run has finished. Collective. */
  void
  note_finished(const std::string &directory,
                const RunSetup    &run,
                const double       wall_seconds,
                const MPI_Comm     comm);

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
