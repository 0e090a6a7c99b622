// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_parameter_keys_h
#define morula_base_parameter_keys_h

#include <morula/base/key.h>

#include <algorithm>
#include <iosfwd>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** A statement of a .prm file: 'set' or 'subsection'. */
  struct Statement
  {
    bool        is_section;
    std::string path;  // full path of the key or section, separated by '/'
    std::string value; // of the key
    std::string place; // of the statement, "file:line: "
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


  /** All keys of a scene, for messages and for --parameters. */
  class ParameterKeys
  {
  public:
    /** @param keys in the order in which they are printed; must outlive this */
    explicit ParameterKeys(const KeyList &keys);

    /**
     * The path that a key has today: that of a renamed key if @p path is its
     * former one, else @p path.
     */
    std::string
    current_name(const std::string &path) const
    {
      const AnyKey *key = find(path);
      return key == nullptr ? path : key->path();
    }

    /**
     * Applies a statement to the keys.
     * @throws InputError for an unknown key or section (with the most similar
     *         one that exists) or a value that does not match the pattern (with
     *         the most similar choice)
     */
    void
    apply(const Statement &statement) const;

    /** Prints a .prm file with every key, its meaning and what is allowed. */
    void
    print(std::ostream &out) const;

    /** Prints a list of all keys as JSON: path, type, unit, allowed, choices,
     *  default, defaults by Method, meaning, former paths, and for expressions
     *  the number of components, when they are evaluated and the variables that
     *  they may use. Keys that a scene sets have its @p values, too. */
    void
    print_json(std::ostream                             &out,
               const std::map<std::string, std::string> &values = {}) const;

  private:
    bool
    has_section(const std::string &path) const
    {
      return std::find(sections.begin(), sections.end(), path) !=
             sections.end();
    }

    [[noreturn]] void
    refuse_unknown(const Statement &statement) const;

    /** The key that has this path today, or null. */
    AnyKey *
    find(const std::string &path) const;

    const KeyList            keys;
    std::vector<std::string> sections;
  };


  /** Values as JSON, each a piece of text. (Boost's property trees write every
   *  number as text.) */
  namespace Json
  {
    /** A text in quotes. */
    std::string
    text(const std::string &value);

    /** A number with its shortest digits; null if it is not finite. */
    std::string
    number(const double value);

    /** A list of texts. */
    std::string
    texts(const std::vector<std::string> &values);

    /** A list of values. */
    std::string
    list(const std::vector<std::string> &values);

    /** An object: names, and values as JSON. */
    std::string
    object(const std::vector<std::pair<std::string, std::string>> &members);
  } // namespace Json
} // namespace Morula

#endif
