// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_program_command_line_h
#define morula_program_command_line_h

#include <morula/effects/catalogue.h>

#include <iosfwd>
#include <string>
#include <vector>

namespace Morula
{
  /** What the command line asks for. */
  struct CommandLine
  {
    /** May be empty only with @ref parameters, @ref serve, @ref version or
     *  @ref help. */
    std::string              scene_file;
    std::vector<std::string> overrides; // "Section/Key=value"
    /** The words as a shell reads them. */
    std::string text;
    bool        resume     = false;
    bool        replace    = false;
    bool        explain    = false;
    bool        parameters = false;
    /** With @ref parameters only those keys are printed that have all of these
     *  words. */
    std::vector<std::string> words;
    /** Whether @ref explain or @ref parameters print JSON. */
    bool json    = false;
    bool serve   = false;
    bool version = false;
    bool help    = false;

    /**
     * Parses the words of the command line, without the program's name.
     * @throws InputError for unknown or contradictory words
     */
    static CommandLine
    parse(const std::vector<std::string> &words);
  };

  /** Becomes the tool that a command line's first word names, such as `report`,
   *  in this process; that word may not be a file. Returns only if it is none.
   *  @param argv ends with a null pointer
   *  @return whether it is one that is not there, of which it has been said */
  bool
  run_tool(char *argv[]);

  /** Prints usage, commands, options and exit codes, or those of the command
   *  `explain` or `keys` alone. */
  void
  print_help(std::ostream &out, const CommandLine &command);

  /** Prints the versions of Morula and deal.II. */
  void
  print_version(std::ostream &out);

  /** Prints every key with meaning, unit, allowed values and default, as a .prm
   *  file or as JSON; also the keys of the types and fields that the scene of
   * @p command names, if there is one; only those with its words.
   *  @throws InputError for a scene that cannot be read, and for words that no
   *  key has */
  void
  print_parameters(std::ostream      &out,
                   const CommandLine &command   = {},
                   const Catalogue   &catalogue = Catalogue());
} // namespace Morula

#endif
