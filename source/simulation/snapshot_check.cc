// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/parameter_file.h>
#include <morula/scene/refusals.h>
#include <morula/simulation/snapshot_check.h>

#include <map>
#include <sstream>

namespace Morula
{
  namespace
  {
    bool
    may_differ(const std::string &path)
    {
      // Method gives other keys their defaults; those are compared themselves
      return path == "Method" || path == "Output directory" ||
             path == "Time/End time" || path == "Time/Step" ||
             path == "Time/Stop at cells" || path.rfind("Solver/", 0) == 0 ||
             path.rfind("Output/", 0) == 0;
    }

    std::map<std::string, std::string>
    values(const std::string &parameters, const std::string &name)
    {
      std::istringstream                 input(parameters);
      std::map<std::string, std::string> map;
      for (const Statement &statement : read_statements(input, name))
        if (statement.kind == Statement::set)
          map[statement.path] = statement.value;
      return map;
    }
  } // namespace

  void
  check_resumable(const Scene &scene, const std::string &parameters)
  {
    // The program that wrote the snapshot may not have had a key yet. Then the
    // key's default counts: a new key's default is what was done before.
    auto before = values(parameters, "the snapshot's scene");
    before.merge(
      values(scene.with_defaults().parameters(), "the default scene"));
    const auto now = values(scene.parameters(), "the scene");
    for (const auto &[path, value] : before)
      if (now.count(path) == 0)
        throw InputError(path,
                         value,
                         "a key that this program knows",
                         "The snapshot was written by another version of "
                         "Morula: resume with that one, or start a new run "
                         "without --resume.");
    for (const auto &[path, value] : now)
      {
        if (may_differ(path) || Refusals::same_value(before.at(path), value))
          continue;
        throw InputError(
          path,
          value,
          "'" + before.at(path) + "', as in the snapshot",
          "A resumed run may differ only in Time/End time, Time/Step, "
          "Time/Stop at cells, Solver and Output. Put the old value back, or "
          "start a new run without --resume.");
      }
  }
} // namespace Morula
