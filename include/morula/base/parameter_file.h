// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_parameter_file_h
#define morula_base_parameter_file_h

#include <iosfwd>
#include <string>
#include <vector>

namespace Morula
{
  /** A statement of a .prm file: 'set' or 'subsection'. */
  struct Statement
  {
    enum Kind
    {
      set,
      section
    };

    Kind        kind;
    std::string path;  // full path of the key or section, separated by '/'
    std::string value; // of the key
    std::string place; // of the statement, "file:line: "
    // The beginnings of the subsections around it, "file:line", outermost
    // first.
    std::vector<std::string> around = {};
  };

  /**
   * The statements of a .prm file, with the full path of every key, which the
   * messages of deal.II's ParameterHandler lack. The grammar is that of
   * deal.II: set, subsection ... end, include, comments from '#' on, and '\' at
   * the end of a line that continues. A file named by include is searched in
   * the working directory, then next to the file that includes it.
   * @throws InputError for a file that cannot be read, a line that is no
   *         statement, an end without a subsection, and subsections without an
   *         end (with the line where the first of them begins)
   */
  std::vector<Statement>
  read_statements(const std::string &file);

  /** Reads statements from a stream. Messages call it @p name. */
  std::vector<Statement>
  read_statements(std::istream &input, const std::string &name);

  /**
   * The statement for the command line's word "Section/Key=value".
   * @throws InputError if it has no '='
   */
  Statement
  read_override(const std::string &text);
} // namespace Morula

#endif
