// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/name_list.h>
#include <morula/base/parameter_keys.h>
#include <morula/base/version.h>
#include <morula/program/command_line.h>
#include <morula/scene/scene.h>

#include <deal.II/base/config.h>
#include <deal.II/base/parameter_handler.h>

#include <boost/algorithm/string.hpp>
#include <boost/program_options.hpp>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iomanip>
#include <iostream>

namespace Morula
{
  namespace options = boost::program_options;

  namespace
  {
    const std::string usage =
      "morula SCENE.prm [-s \"Section/Key=value\"]... [--resume | --replace]";

    /** A program of contrib that works on scenes or runs. */
    struct Tool
    {
      std::string word, file, summary;
    };

    const std::vector<Tool> tools = {
      {"report", "report", "one page about a run, for a browser"},
      {"render", "render", "pictures and films of a run's cells"},
      {"shapes",
       "cell-shapes",
       "the cells of a run as polyhedra, for ParaView"},
      {"export", "export", "a run for other programs: tracks, tables, images"},
      {"import", "import", "a scene of a segmented image or a tracker's table"},
      {"sweep", "sweep", "many runs of a scene, with their mean and scatter"},
      {"accuracy", "accuracy", "how accurate a scene is, and at what cost"}};

    bool
    is_file(const std::string &word)
    {
      std::error_code error;
      return std::filesystem::is_regular_file(word, error);
    }

    options::options_description
    visible_options()
    {
      // print_help() prints these. What a program needs only inside, as the
      // place of the scene, is added in parse().
      options::options_description result("Options");
      result.add_options()(
        "set,s",
        options::value<std::vector<std::string>>()->value_name("KEY=VALUE"),
        "override one key, e.g. -s \"Time/End time=2\"; may be repeated")(
        "resume", "go on from the last snapshot in the output directory")(
        "replace",
        "delete the run in the output directory, also one of another scene or "
        "one that is not finished")(
        "explain",
        options::value<std::string>()->value_name("[=json]"),
        "check the scene, print what it will simulate, and stop; "
        "--explain=json for programs")(
        "parameters",
        options::value<std::string>()->value_name("[=json]"),
        "print every key with default, units and allowed values; with a scene "
        "also those of its types of cells, fields and obstacles; with a WORD "
        "those that have it in path or meaning; --parameters=json for "
        "programs")("serve",
                    "do runs as standard input asks for them, each in a fork "
                    "of this process (contrib/python/morula/served.py)")(
        "version", "print the version")("help,h", "print this text");
      return result;
    }

    InputError
    wrong_command_line(const std::string &why)
    {
      return InputError(why + " Usage: " + usage +
                        "; 'morula --help' explains it.");
    }

    /** Whether an option is to print JSON.
     *  @throws InputError for another value than json */
    bool
    is_json(const options::variables_map &found, const std::string &option)
    {
      if (found.count(option) == 0)
        return false;
      const std::string value = found[option].as<std::string>();
      if (value != "text" && value != "json")
        throw wrong_command_line("--" + option +
                                 " takes no value but json and text.");
      return value == "json";
    }

    /** Whether a word beside --parameters names a scene. */
    bool
    is_scene(const std::string &word)
    {
      // A word that ends in .prm counts even if there is no such file: then the
      // message says that the scene cannot be read, and not that no key has the
      // word.
      return boost::ends_with(word, ".prm") || is_file(word);
    }

    options::variables_map
    options_of(std::vector<std::string> words)
    {
      options::options_description every = visible_options();
      every.add_options()("scene", options::value<std::vector<std::string>>());
      options::positional_options_description positions;
      positions.add("scene", -1);

      // The value of an option stands behind '=': a word beside --parameters is
      // one to look for. Two commands are options of this program.
      if (!words.empty() && !is_file(words[0]))
        words[0] = words[0] == "explain" ? "--explain" :
                   words[0] == "keys"    ? "--parameters" :
                                           words[0];
      for (std::string &word : words)
        if (word == "--explain" || word == "--parameters")
          word += "=text";

      options::variables_map found;
      try
        {
          using namespace options::command_line_style;
          options::store(options::command_line_parser(words)
                           .options(every)
                           .positional(positions)
                           .style(unix_style & ~allow_guessing)
                           .run(),
                         found);
        }
      catch (const options::error &error)
        {
          throw wrong_command_line(std::string(error.what()) + ".");
        }
      return found;
    }
  } // namespace


  CommandLine
  CommandLine::parse(const std::vector<std::string> &words)
  {
    // Boost splits the words into options and the rest, and refuses unknown
    // options. Then come the checks that it cannot make: which options exclude
    // each other, and that there is one scene unless the option needs none. The
    // line is kept as a shell reads it. Abbreviated options are not allowed,
    // since a new option could change their meaning.
    CommandLine result;
    for (const std::string &word : words)
      result.text +=
        (result.text.empty() ? "" : " ") +
        (word.find_first_of(" ;()&|<>*?$\"\\#!^'") == std::string::npos ?
           word :
           "'" + boost::replace_all_copy(word, "'", "'\\''") + "'");

    const options::variables_map found = options_of(words);
    result.resume                      = found.count("resume") > 0;
    result.replace                     = found.count("replace") > 0;
    result.explain                     = found.count("explain") > 0;
    result.parameters                  = found.count("parameters") > 0;
    result.version                     = found.count("version") > 0;
    result.help                        = found.count("help") > 0;
    result.serve                       = found.count("serve") > 0;
    result.json = is_json(found, "explain") || is_json(found, "parameters");
    if (result.resume && result.replace)
      throw wrong_command_line("Either go on with the run, or replace it: "
                               "leave one of the two out.");
    if (found.count("set") > 0)
      result.overrides = found["set"].as<std::vector<std::string>>();
    // All words without an option arrive as scenes. With --parameters those
    // that are no file are words to look for. More than one scene mostly comes
    // from an override with blanks that is not quoted.
    auto scenes = found.count("scene") > 0 ?
                    found["scene"].as<std::vector<std::string>>() :
                    std::vector<std::string>();
    if (result.parameters)
      {
        const auto words =
          std::stable_partition(scenes.begin(), scenes.end(), is_scene);
        result.words.assign(words, scenes.end());
        scenes.erase(words, scenes.end());
      }
    if (scenes.size() > 1)
      throw wrong_command_line("Name one scene, not '" + scenes[0] + "' and '" +
                               scenes[1] +
                               "'; quote a -s option that has blanks.");
    if (!scenes.empty())
      result.scene_file = scenes[0];
    else if (!result.parameters && !result.version && !result.help &&
             !result.serve)
      throw wrong_command_line("Name the scene.");
    return result;
  }


  bool
  run_tool(char *argv[])
  {
    // A tool stands in contrib of the tree whose build directory has this
    // program, beside an installed one, or in the path. It learns from the
    // environment which program to call.
    namespace fs = std::filesystem;
    const auto tool =
      std::find_if(tools.begin(), tools.end(), [&](const Tool &one) {
        return argv[1] != nullptr && one.word == argv[1] && !is_file(one.word);
      });
    if (tool == tools.end())
      return false;
    std::error_code error;
    const fs::path  program = fs::read_symlink("/proc/self/exe", error),
                   here     = program.parent_path();
    setenv("MORULA", program.c_str(), 1);
    for (const fs::path &place : {here.parent_path() / "contrib" / tool->file,
                                  here / ("morula-" + tool->file),
                                  fs::path("morula-" + tool->file)})
      execvp(place.c_str(), argv + 1);
    std::cerr << "morula: the command " << tool->word
              << " needs the Python program morula-" << tool->file
              << ", which is neither beside " << program
              << " nor in the PATH.\n";
    return true;
  }


  void
  print_help(std::ostream &out, const CommandLine &command)
  {
    // Two commands are options of this program, which say what they do.
    if (command.explain || command.parameters)
      {
        out << "usage: morula "
            << (command.explain ? "explain SCENE.prm" :
                                  "keys [SCENE.prm] [WORD]...")
            << " [-s \"Section/Key=value\"]...\n\n"
            << visible_options()
                 .find(command.explain ? "explain" : "parameters", false)
                 .description()
            << '\n';
        return;
      }
    out
      << "Morula simulates growing and proliferating tissue.\n\nUsage: "
      << usage << "\n       mpirun -np N morula SCENE.prm ...\n"
      << "       morula COMMAND ...\n\n"
      << "Commands (morula COMMAND --help explains one):\n"
      << "  explain SCENE.prm      check a scene, and say what it simulates\n"
      << "  keys [WORD]...         the keys of scenes, or those about a word\n"
      << std::left;
    for (const Tool &tool : tools)
      out << "  " << std::setw(23) << tool.word << tool.summary << '\n';
    out << '\n'
        << visible_options()
        << "\nExit codes: 0 finished; 1 bad input, nothing was computed or "
           "written;\n2 the run failed; go on with --resume from its last "
           "snapshot.\n";
  }


  void
  print_version(std::ostream &out)
  {
    out << "Morula " << version_in_words() << " with deal.II "
        << DEAL_II_PACKAGE_VERSION << '\n';
  }


  namespace
  {
    /** Whether path or meaning of a key have a word, or the path what keys call
     *  that. */
    bool
    is_about(const AnyKey &key, const std::string &word)
    {
      const std::vector<std::string> others = words_of_keys(word);
      return boost::icontains(key.path() + ' ' + key.documentation(), word) ||
             std::any_of(others.begin(),
                         others.end(),
                         [&key](const std::string &other) {
                           return boost::icontains(key.path(), other);
                         });
    }

    /** Whether a key of a type is that of all cells, or of a second type. */
    bool
    repeats_another(const AnyKey &key)
    {
      return boost::starts_with(key.documentation(), "For cells of this") ||
             boost::starts_with(key.path(), "Cell types/OTHER/");
    }
  } // namespace


  void
  print_parameters(std::ostream      &out,
                   const CommandLine &command,
                   const Catalogue   &catalogue)
  {
    // Sections of types, fields and obstacles exist only where a scene names
    // them. So the scene is read for its names and values, and its sections are
    // declared in a fresh scene, which has the defaults to print; without a
    // scene words are looked for in those of one name each. Each word then
    // removes the keys that do not have it, so that several words mean all of
    // them, unless they are one name of the field, as "cell size" is.
    Scene scene(catalogue);
    if (!command.scene_file.empty())
      scene.as_written =
        Scene::read(command.scene_file, command.overrides, catalogue)
          .as_written;
    else if (!command.words.empty())
      scene.as_written = {{"Cell types/Names", "NAME, OTHER"},
                          {"Fields/Names", "field"},
                          {"Cell numbers/Names", "number"},
                          {"Obstacles/Names", "name"},
                          {"Lumens/Names", "name"}};
    scene.declare_sections(scene.as_written);
    KeyList           keys   = scene.list();
    const std::string phrase = boost::join(command.words, " ");
    for (const std::string &word : words_of_keys(phrase).empty() ?
                                     command.words :
                                     std::vector<std::string>{phrase})
      {
        keys.erase(std::remove_if(keys.begin(),
                                  keys.end(),
                                  [&](const AnyKey *key) {
                                    return !is_about(*key, word) ||
                                           (command.scene_file.empty() &&
                                            repeats_another(*key));
                                  }),
                   keys.end());
        if (keys.empty())
          {
            const std::string other = similar_word(word);
            throw InputError(
              "No key has '" + printable(word) + "' in its path or meaning" +
              (command.words.size() > 1 ? ", and the words before it." : ".") +
              (other.empty() ? "" : " Did you mean '" + other + "'?"));
          }
      }
    if (command.json)
      ParameterKeys(keys).print_json(out, scene.as_written);
    else
      ParameterKeys(keys).print(out);
  }
} // namespace Morula
