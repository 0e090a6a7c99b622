// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_run_record_h
#define morula_output_run_record_h

#include <optional>
#include <string>

namespace Morula
{
  /**
   * What a later run must know about a run that it finds in its directory. It
   * stands in the comments at the beginning of parameters.prm.
   *
   *     # A run of Morula 0.2.0.
   *     # scene: ../../prm/demo.prm
   *     # state: finished after 84.2 s
   */
  struct RunRecord
  {
    /**
     * The scene's file, relative to the directory. So the record stays true
     * when scenes and runs are moved or copied together, and two scenes of the
     * same name in different directories are different.
     */
    std::string scene;
    bool        finished     = false;
    double      wall_seconds = 0.; // of a finished run

    /** The comments, complete lines. */
    std::string
    comments() const;

    /** The record of the run in a directory. Nothing if there are no such
     *  comments. */
    static std::optional<RunRecord>
    read(const std::string &directory);
  };

  /** The path of `parameters.prm` in a directory. */
  std::string
  parameters_file(const std::string &directory);

  /** Whether @p scene_file is the parameters.prm of the directory. Then the run
   *  is repeated from its own keys. */
  bool
  is_own_parameters(const std::string &directory,
                    const std::string &scene_file);

  /** RunRecord::scene for a run of @p scene_file. A run that is repeated from
   *  its own keys keeps the name that it had. */
  std::string
  recorded_name(const std::string &directory, const std::string &scene_file);
} // namespace Morula

#endif
