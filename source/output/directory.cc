// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/version.h>
#include <morula/output/directory.h>
#include <morula/output/progress.h>

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>

namespace Morula
{
  namespace fs = std::filesystem;

  namespace
  {
    const char *const key = "Output directory";

    /** The next run does not replace one that took longer, seconds. An hour of
     *  work is not lost because somebody starts the scene again by mistake. */
    constexpr double longest_replaceable = 3600.;

    /** Throws an InputError about a path, with the system's reason. */
    [[noreturn]] void
    refuse(const fs::path &path, const std::error_code &error)
    {
      throw InputError(key,
                       path.string(),
                       "a directory that can be written (" + error.message() +
                         ")",
                       "Choose another one, or change its permissions.");
    }

    /** Number of a file in a series; -1 if the file is of no series. */
    long long
    series_number(const std::string &name)
    {
      // 18 digits are what stoll() can read for sure.
      static const std::regex pattern(
        "(?:cells|surface)-([0-9]{4,18})\\.(?:vtu|pvtu|csv)(?:\\.tmp)?");
      std::smatch match;
      return std::regex_match(name, match, pattern) ? std::stoll(match[1]) : -1;
    }

    /** Whether a run of Morula writes a file of this name. */
    bool
    is_run_file(const std::string &name)
    {
      static const std::regex pattern(
        "(?:parameters\\.prm|provenance\\.json|log\\.txt|(?:cells|surface)\\.pvd|"
        "(?:condition|events|forces|lineage|newton|statistics|timings)\\.csv|"
        "snapshot\\.h5(?:\\.trial)?)(?:\\.tmp)?");
      return series_number(name) >= 0 || std::regex_match(name, pattern);
    }

    template <typename Predicate>
    std::vector<fs::path>
    files_with(const fs::path &directory, const Predicate &wanted)
    {
      // The entries are listed without exceptions, so that every error names
      // the directory.
      std::vector<fs::path>  files;
      std::error_code        error;
      fs::directory_iterator entries(directory, error);
      for (; !error && entries != fs::directory_iterator();
           entries.increment(error))
        if (!entries->is_directory(error) &&
            wanted(entries->path().filename().string()))
          files.push_back(entries->path());
      if (error)
        refuse(directory, error);
      return files;
    }

    void
    remove(const std::vector<fs::path> &files)
    {
      std::error_code error;
      for (const fs::path &file : files)
        if (!fs::remove(file, error) && error)
          refuse(file, error);
    }

    /** @param why a clause after "there is one" that says why the old run must
     *    not be lost */
    [[noreturn]] void
    refuse_to_replace(const std::string &directory,
                      const std::string &why,
                      const std::string &remedy)
    {
      throw InputError(key,
                       directory,
                       "a directory without a run that would be lost, but "
                       "there is one " +
                         why,
                       remedy);
    }

    /** The path of `parameters.prm` in a directory. */
    std::string
    parameters_file(const std::string &directory)
    {
      return (fs::path(directory) / "parameters.prm").string();
    }

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
       * when scenes and runs are moved or copied together, and two scenes of
       * the same name in different directories are different.
       */
      std::string scene;
      bool        finished     = false;
      double      wall_seconds = 0.; // of a finished run

      /** The record of the run in a directory. Nothing if there are no such
       *  comments. */
      static std::optional<RunRecord>
      read(const std::string &directory)
      {
        // Three lines in front of parameters.prm; any other beginning is not of
        // Morula, or of one without records.
        std::ifstream in(parameters_file(directory));
        std::string   first, second, third;
        std::getline(in, first);
        std::getline(in, second);
        std::getline(in, third);
        static const std::regex scene_line("# scene: (.*)");
        static const std::regex state_line(
          "# state: (?:not finished|finished after ([0-9.e+-]+) s)");
        std::smatch scene, state;
        if (!in || first.rfind("# A run of Morula ", 0) != 0 ||
            !std::regex_match(second, scene, scene_line) ||
            !std::regex_match(third, state, state_line))
          return {};
        RunRecord record;
        record.scene    = scene[1];
        record.finished = state[1].matched;
        if (record.finished)
          std::istringstream(state[1]) >> record.wall_seconds;
        return record;
      }
    };

    /** The absolute path, with links resolved as far as the path exists. */
    fs::path
    full_path(const std::string &path, std::error_code &error)
    {
      const fs::path absolute = fs::absolute(path, error);
      return error ? fs::path() : fs::weakly_canonical(absolute, error);
    }

    /** RunRecord::scene for a run of @p scene_file. A run that is repeated from
     *  its own keys keeps the name that it had. */
    std::string
    recorded_name(const std::string &directory, const std::string &scene_file)
    {
      // A run that was started from its own parameters.prm is still of the
      // scene that it was of before.
      std::error_code ignored; // a missing file is another file
      if (fs::equivalent(parameters_file(directory), scene_file, ignored))
        if (const auto record = RunRecord::read(directory))
          return record->scene;
      std::error_code error;
      std::string     name  = scene_file;
      const fs::path  scene = full_path(scene_file, error);
      const fs::path  from  = error ? fs::path() : full_path(directory, error);
      // A relative path stays right when directory and scene are moved
      // together.
      if (!error)
        name = scene.lexically_relative(from).string();
      for (char &c : name) // a comment is one line
        if (static_cast<unsigned char>(c) < ' ' || c == '\\')
          c = '?';
      return name;
    }

    void
    write_parameters(const std::string &directory,
                     const RunSetup    &run,
                     const RunRecord   &record)
    {
      // The record names the scene that the run is of, also if it was started
      // from its own parameters.prm.
      std::ostringstream text;
      text << "# A run of Morula " << version_number()
           << ".\n# scene: " << recorded_name(directory, run.scene_file)
           << "\n# state: ";
      if (record.finished)
        text << "finished after " << record.wall_seconds << " s\n";
      else
        text << "not finished\n";
      write_atomically(parameters_file(directory), text.str() + run.parameters);
    }

  } // namespace

  std::string
  numbered_file(const std::string &stem,
                const unsigned int number,
                const std::string &extension)
  {
    char digits[16];
    std::snprintf(digits, sizeof(digits), "%04u", number);
    return stem + '-' + digits + '.' + extension;
  }

  void
  check_directory(const std::string &directory)
  {
    if (directory.empty())
      throw InputError(key,
                       directory,
                       "the path of a directory",
                       "Name one, for instance 'output'.");

    // The path itself is tested, or the nearest directory above it that exists.
    std::error_code error;
    fs::path        existing = fs::absolute(directory, error);
    while (!error && !fs::exists(existing, error) && !error &&
           existing.has_relative_path())
      existing = existing.parent_path();
    if (error)
      refuse(existing, error);

    if (!fs::is_directory(existing, error))
      throw InputError(key,
                       directory,
                       "a directory, but '" + existing.string() + "' is a file",
                       "Choose another one.");
    // The system knows whether this process may write there.
    if (::access(existing.c_str(), W_OK | X_OK) != 0)
      refuse(existing, std::error_code(errno, std::generic_category()));
  }

  void
  create_directory(const std::string &directory)
  {
    check_directory(directory);
    std::error_code error;
    fs::create_directories(directory, error);
    if (error && !fs::is_directory(directory))
      refuse(directory, error);
  }

  void
  check_replaceable(const std::string &directory,
                    const std::string &scene_file,
                    const bool         replace)
  {
    // A directory may hold no run, somebody's files, or a run. Files that only
    // look like a run's are never deleted. Of a run the record says what it is.
    // It may be replaced without being asked for if it is finished, of the same
    // scene, and took less than an hour: anything else needs --replace.
    std::error_code error;
    if (!fs::is_directory(directory, error))
      return;
    const std::vector<fs::path> files =
      files_with(directory, [](const std::string &name) {
        // A run that was killed at its very beginning leaves this file.
        return is_run_file(name) && name != "parameters.prm.tmp";
      });
    if (files.empty())
      return;
    const auto record = RunRecord::read(directory);
    if (!record)
      throw InputError(key,
                       directory,
                       "a directory without files of the names that Morula "
                       "gives, unless a run of Morula wrote them (there is '" +
                         files.front().filename().string() +
                         "', but no parameters.prm of such a run)",
                       "Move such files, or choose another directory.");
    if (replace)
      return;

    const std::string delete_it =
      "--replace deletes it, or choose another directory.";
    if (record->scene != recorded_name(directory, scene_file))
      refuse_to_replace(directory,
                        "of another scene, '" + record->scene + "'",
                        delete_it);
    if (!record->finished)
      refuse_to_replace(directory,
                        "that is not finished",
                        (fs::exists(fs::path(directory) / "snapshot.h5",
                                    error) ?
                           "--resume goes on with it; " :
                           "It has no snapshot to go on from; ") +
                          delete_it);
    if (record->wall_seconds > longest_replaceable)
      refuse_to_replace(directory,
                        "that took " + duration(record->wall_seconds),
                        delete_it);
  }

  void
  prepare_directory(const std::string &directory,
                    const RunSetup    &run,
                    const MPI_Comm     comm)
  {
    on_root(comm, [&]() {
      // The inputs of the scene may stand in the directory as well. They are
      // looked for before anything is deleted.
      create_directory(directory);
      check_replaceable(directory, run.scene_file, run.replace);
      std::vector<fs::path> old_run = files_with(directory, is_run_file);
      std::error_code       ignored; // a missing input cannot be removed
      for (const fs::path &file : old_run)
        for (const std::string &input : run.inputs)
          if (fs::equivalent(file, input, ignored))
            throw InputError(key,
                             directory,
                             "a directory whose run may be replaced, but the "
                             "scene reads '" +
                               input + "'",
                             "Choose another directory.");
      // The record is written first, so that a run that is killed here leaves
      // no files without one.
      write_parameters(directory, run, {});
      // parameters.prm has just been replaced, and stays.
      old_run.erase(std::remove_if(old_run.begin(),
                                   old_run.end(),
                                   [](const fs::path &file) {
                                     return file.filename() == "parameters.prm";
                                   }),
                    old_run.end());
      remove(old_run);
    });
  }

  void
  prepare_resume(const std::string &directory,
                 const RunSetup    &run,
                 const unsigned int first_number,
                 const MPI_Comm     comm)
  {
    on_root(comm, [&]() {
      check_directory(directory);
      // Files of series behind the snapshot belong to a future that is computed
      // again.
      remove(files_with(directory, [&](const std::string &name) {
        return series_number(name) >= static_cast<long long>(first_number);
      }));
      write_parameters(directory, run, {});
    });
  }

  void
  note_finished(const std::string &directory,
                const RunSetup    &run,
                const double       wall_seconds,
                const MPI_Comm     comm)
  {
    on_root(comm, [&]() {
      write_parameters(directory, run, {"", true, wall_seconds});
    });
  }
} // namespace Morula
