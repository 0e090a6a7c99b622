// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/version.h>
#include <morula/output/run_record.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace Morula
{
  namespace fs = std::filesystem;

  namespace
  {
    /** The absolute path, with links resolved as far as the path exists. */
    fs::path
    full_path(const std::string &path, std::error_code &error)
    {
      const fs::path absolute = fs::absolute(path, error);
      return error ? fs::path() : fs::weakly_canonical(absolute, error);
    }
  } // namespace

  std::string
  RunRecord::comments() const
  {
    std::ostringstream text;
    text << "# A run of Morula " << version_number() << ".\n"
         << "# scene: " << scene << "\n# state: ";
    if (finished)
      text << "finished after " << wall_seconds << " s\n";
    else
      text << "not finished\n";
    return text.str();
  }

  std::optional<RunRecord>
  RunRecord::read(const std::string &directory)
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

  std::string
  parameters_file(const std::string &directory)
  {
    return (fs::path(directory) / "parameters.prm").string();
  }

  bool
  is_own_parameters(const std::string &directory, const std::string &scene_file)
  {
    std::error_code ignored; // a missing file is another file
    return fs::equivalent(parameters_file(directory), scene_file, ignored);
  }

  std::string
  recorded_name(const std::string &directory, const std::string &scene_file)
  {
    // A run that was started from its own parameters.prm is still of the scene
    // that it was of before.
    if (is_own_parameters(directory, scene_file))
      if (const auto record = RunRecord::read(directory))
        return record->scene;
    std::error_code error;
    std::string     name  = scene_file;
    const fs::path  scene = full_path(scene_file, error);
    const fs::path  from  = error ? fs::path() : full_path(directory, error);
    // A relative path stays right when directory and scene are moved together.
    if (!error)
      name = scene.lexically_relative(from).string();
    for (char &c : name) // a comment is one line
      if (static_cast<unsigned char>(c) < ' ' || c == '\\')
        c = '?';
    return name;
  }
} // namespace Morula
