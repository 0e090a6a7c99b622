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

  /**
   * Makes the directory ready for a new run: creates it, removes the files of
   * the run it finds there (those with the names that Morula gives, no others),
   * and writes parameters.prm. Collective.
   * @param parameters the scene, a .prm file with all keys
   * @param inputs     files that the scene reads
   * @throws InputError, on all ranks, as check_directory(), or if one of the
   *   inputs would be removed
   */
  void
  prepare_directory(const std::string              &directory,
                    const std::string              &parameters,
                    const std::vector<std::string> &inputs,
                    const MPI_Comm                  comm);

  /**
   * Makes the directory ready to resume a run: writes parameters.prm and
   * removes the numbered files from @p first_number on, which were written
   * after the snapshot. Collective; errors as above.
   */
  void
  prepare_resume(const std::string &directory,
                 const std::string &parameters,
                 const unsigned int first_number,
                 const MPI_Comm     comm);
} // namespace Morula

#endif
