// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_run_record_h
#define morula_output_run_record_h

#include <optional>
#include <string>

namespace Morula
{
  /**
   * What a later run must know of the one that it finds in its directory: the
   * comments at the beginning of parameters.prm.
   *
   *     # A run of Morula 0.1.0.
   *     # scene: ../../prm/demo.prm
   *     # state: finished after 84.2 s
   */
  struct RunRecord
  {
    /**
     * The scene's file, as seen from the directory: so the record holds when
     * scenes and runs are moved or copied together, and two scenes of one name
     * in different directories are told from each other.
     */
    std::string scene;
    bool        finished     = false;
    double      wall_seconds = 0.; // of a finished run

    /** The comments, complete lines. */
    std::string
    comments() const;

    /** Of the run in a directory; none if it has no such comments. */
    static std::optional<RunRecord>
    read(const std::string &directory);
  };

  /** `parameters.prm` in a directory. */
  std::string
  parameters_file(const std::string &directory);

  /** Whether @p scene_file is the parameters.prm of the directory: a run that
   *  is repeated from its own keys. */
  bool
  is_own_parameters(const std::string &directory,
                    const std::string &scene_file);

  /** What RunRecord::scene is for a run of @p scene_file; a run that is
   *  repeated from its own keys keeps the name that it had. */
  std::string
  recorded_name(const std::string &directory, const std::string &scene_file);
} // namespace Morula

#endif
