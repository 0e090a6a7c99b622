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
   * Whether a run can write into the directory, or create it. Touches nothing;
   * for a scene's check.
   * @throws InputError if the path is no directory, or not writable
   */
  void
  check_directory(const std::string &directory);

  /** @throws InputError as check_directory() */
  void
  create_directory(const std::string &directory);

  /** The run that is to go into a directory. */
  struct ComingRun
  {
    std::string              scene_file;
    std::string              parameters;      // a .prm file with all keys
    std::vector<std::string> inputs;          // files that the scene reads
    bool                     replace = false; // any run, not only its own
  };

  /**
   * Refuses a directory whose run would be lost: one of another scene file, one
   * that is not finished, or that took more than an hour; and one that holds
   * files with the names that Morula gives, but no run of Morula. Touches
   * nothing. For one rank.
   * @param replace accept any run of Morula
   * @throws InputError
   */
  void
  check_replaceable(const std::string &directory,
                    const std::string &scene_file,
                    const bool         replace);

  /**
   * Makes the directory ready for a new run: creates it, writes parameters.prm,
   * and removes the other files of the run it finds there (those with the names
   * that Morula gives, no others). Collective.
   * @throws InputError, on all ranks, as check_directory() and
   *   check_replaceable(), or if one of the inputs would be removed
   */
  void
  prepare_directory(const std::string &directory,
                    const ComingRun   &run,
                    const MPI_Comm     comm);

  /**
   * Makes the directory ready to resume a run: writes parameters.prm and
   * removes the numbered files from @p first_number on, which were written
   * after the snapshot. Collective; errors as above.
   */
  void
  prepare_resume(const std::string &directory,
                 const ComingRun   &run,
                 const unsigned int first_number,
                 const MPI_Comm     comm);

  /** Notes in parameters.prm that the run has ended as it should. Collective.
   */
  void
  note_finished(const std::string &directory,
                const ComingRun   &run,
                const double       wall_seconds,
                const MPI_Comm     comm);
} // namespace Morula

#endif
