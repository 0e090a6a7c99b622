// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_parameter_keys_h
#define morula_base_parameter_keys_h

#include <morula/base/parameter_file.h>

#include <deal.II/base/parameter_handler.h>

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** What was declared about one key. */
  struct ParameterKey
  {
    std::string path; // full, separated by '/'
    std::string default_value;
    std::string documentation;
    std::string allowed; // noun phrase
    std::string unit;    // of "Units: " in the documentation, or empty
    std::vector<std::string> choices;       // words, if it is chosen from some
    bool                     is_of_numbers; // real ones: one, or a list
  };

  /** The declared keys, for messages and for --parameters. */
  class ParameterKeys
  {
  public:
    explicit ParameterKeys(const ParameterHandler &prm);

    /** All keys, in the order of their declaration. */
    const std::vector<ParameterKey> &
    list() const &;

    void
    list() const && = delete; // the list would go with the object

    /**
     * The path that a key has today: that of a renamed key if @p path is its
     * former one (declared by ParameterHandler::declare_alias), else @p path.
     */
    std::string
    current_name(const std::string &path) const;

    /**
     * Applies a statement to @p prm, the handler of the constructor.
     * @throws InputError for an unknown key or section (with the most similar
     *         one that exists, or where it stands) or a value that does not
     *         match the pattern (with the most similar choice)
     */
    void
    apply(const Statement &statement, ParameterHandler &prm) const;

    /** Prints a .prm file with every key, its meaning and what is allowed. */
    void
    print(std::ostream &out) const;

  private:
    bool
    has_section(const std::string &path) const;

    /** Whether the statement would make sense without the innermost ones of
     *  the subsections around it: which of these lacks its end; or nothing. */
    std::string
    missing_end(const Statement &statement) const;

    [[noreturn]] void
    refuse_unknown(const Statement &statement) const;

    std::vector<ParameterKey>          keys;
    std::vector<std::string>           sections;
    std::map<std::string, std::string> renamed; // former path -> path
  };
} // namespace Morula

#endif
