// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/input_error.h>
#include <morula/output/agreement.h>
#include <morula/output/atomic_file.h>
#include <morula/output/directory.h>

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <regex>

namespace Morula
{
  namespace fs = std::filesystem;

  namespace
  {
    const char *const key = "Output directory";

    /** With the error of the system; the path is the one it concerns. */
    [[noreturn]] void
    refuse(const fs::path &path, const std::error_code &error)
    {
      throw InputError(key,
                       path.string(),
                       "a directory that can be written (" + error.message() +
                         ")",
                       "Choose another one, or change its permissions.");
    }

    std::string
    parameters_file(const fs::path &directory)
    {
      return (directory / "parameters.prm").string();
    }

    /** Number of a file in a series; -1: not of a series. */
    long long
    series_number(const std::string &name)
    {
      static const std::regex pattern(
        "(?:cells|surface)-([0-9]{4,18})\\.(?:vtu|pvtu|csv)(?:\\.tmp)?");
      std::smatch match;
      return std::regex_match(name, match, pattern) ? std::stoll(match[1]) : -1;
    }

    /** Whether a run of Morula writes a file of this name. */
    bool
    is_ours(const std::string &name)
    {
      static const std::regex pattern(
        "(?:parameters\\.prm|log\\.txt|(?:cells|surface)\\.pvd|"
        "(?:condition|lineage|statistics|timings)\\.csv|snapshot\\.h5)(?:\\.tmp)?");
      return series_number(name) >= 0 || std::regex_match(name, pattern);
    }

    template <typename Predicate>
    std::vector<fs::path>
    files_with(const fs::path &directory, const Predicate &wanted)
    {
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

    void
    refuse_to_remove_inputs(const std::vector<fs::path>    &files,
                            const std::vector<std::string> &inputs)
    {
      std::error_code ignored; // a missing input is not in the way
      for (const fs::path &file : files)
        for (const std::string &input : inputs)
          if (fs::equivalent(file, input, ignored))
            throw InputError(key,
                             file.parent_path().string(),
                             "a directory whose run may be replaced, but the "
                             "scene reads '" +
                               input + "'",
                             "Choose another directory.");
    }

    void
    write_parameters(const std::string &directory, const std::string &text)
    {
      write_atomically(parameters_file(directory), text);
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

    // the path itself, or the nearest directory above it that is there
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
    if (::access(existing.c_str(), W_OK | X_OK) != 0)
      refuse(existing, std::error_code(errno, std::generic_category()));
  }

  void
  prepare_directory(const std::string              &directory,
                    const std::string              &parameters,
                    const std::vector<std::string> &inputs,
                    const MPI_Comm                  comm)
  {
    on_root(comm, [&]() {
      check_directory(directory);
      std::error_code error;
      fs::create_directories(directory, error);
      if (error && !fs::is_directory(directory))
        refuse(directory, error);

      const std::vector<fs::path> old_run = files_with(directory, is_ours);
      refuse_to_remove_inputs(old_run, inputs);
      remove(old_run);
      write_parameters(directory, parameters);
    });
  }

  void
  prepare_resume(const std::string &directory,
                 const std::string &parameters,
                 const unsigned int first_number,
                 const MPI_Comm     comm)
  {
    on_root(comm, [&]() {
      check_directory(directory);
      remove(files_with(directory, [&](const std::string &name) {
        return series_number(name) >= static_cast<long long>(first_number);
      }));
      write_parameters(directory, parameters);
    });
  }
} // namespace Morula
