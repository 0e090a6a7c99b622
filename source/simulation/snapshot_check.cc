// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/parameter_keys.h>
#include <morula/simulation/snapshot_check.h>

#include <set>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** Paths of the keys in which a resumed run may differ. */
    std::set<std::string>
    may_differ(const Scene &scene)
    {
      // Method is a name for several keys, which are compared by themselves.
      std::set<std::string> paths = {scene.method.path(),
                                     scene.output_directory.path(),
                                     scene.time.end_time.path(),
                                     scene.time.step.path(),
                                     scene.time.stop_at_cells.path()};
      for (const AnyKey *key : scene.solver.list())
        paths.insert(key->path());
      for (const AnyKey *key : scene.output.list())
        paths.insert(key->path());
      // What is off stays off, as the key that switches it on is compared.
      for (const EffectKeys *const keys : scene.effect_keys())
        if (const AnyKey *const on = keys->facts().switch_key; !keys->is_on())
          for (const AnyKey *key : keys->list())
            if (key != on)
              paths.insert(key->path());
      if (!scene.cells_divide())
        for (const AnyKey *key : scene.division.list())
          paths.insert(key->path());
      return paths;
    }

    std::map<std::string, std::string>
    values(const std::string &parameters, const std::string &name)
    {
      // Comments and includes are no statements of this kind, so that only
      // values are compared.
      std::istringstream                 input(parameters);
      std::map<std::string, std::string> map;
      for (const Statement &statement : read_statements(input, name))
        if (!statement.is_section)
          map[statement.path] = statement.value;
      return map;
    }
  } // namespace

  void
  check_resumable(const Scene &scene, const std::string &parameters)
  {
    // Both scenes become maps from key to value. The program that wrote the
    // snapshot may not have had a key yet. Then its default with the paper's
    // method counts, which is what was done before. Keys that are gone are
    // looked for first: they have no value to be compared with.
    auto  before  = values(parameters, "the snapshot's scene");
    Scene without = scene.with_defaults();
    for (AnyKey *const key : without.list())
      key->take_default_of("paper");
    before.merge(values(without.parameters(), "the default scene"));
    const auto now = values(scene.parameters(), "the scene");
    for (const auto &[path, value] : before)
      if (now.count(path) == 0)
        throw InputError(path,
                         value,
                         "a key that this program knows",
                         "The snapshot was written by another version of "
                         "Morula: resume with that one, or start a new run "
                         "without --resume.");
    const std::set<std::string> may = may_differ(scene);
    for (const auto &[path, value] : now)
      {
        // Numbers are compared as such: 1 and 1.0 are the same value.
        if (may.count(path) > 0 || same_value(before.at(path), value))
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
