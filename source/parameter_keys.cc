// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// without this, json_parser.hpp of Boost 1.74 prints a note about placeholders
#define BOOST_BIND_GLOBAL_PLACEHOLDERS

#include <morula/input_error.h>
#include <morula/parameter_keys.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <boost/algorithm/string.hpp>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <ostream>
#include <regex>
#include <sstream>

namespace Morula
{
  namespace
  {
    using Tree = boost::property_tree::ptree;

    /** What is allowed for keys without a pattern, such as expressions. */
    const std::string any_text = "any text";

    /** deal.II's description of a pattern as a short noun phrase. */
    std::string
    noun_phrase(const std::string &machine_description)
    {
      std::string text = Patterns::pattern_factory(machine_description)
                           ->description(Patterns::PatternBase::Text);
      const std::vector<std::pair<std::string, std::string>> shorter = {
        {"floating point number v such that -MAX_DOUBLE <= v <= MAX_DOUBLE",
         "number"},
        {"floating point number v such that (\\S+) <= v <= MAX_DOUBLE",
         "number >= $1"},
        {"integer n such that -2147483648 <= n <= 2147483647", "integer"},
        {"integer n such that (\\S+) <= n <= 2147483647", "integer >= $1"},
        {"integer n such that (\\S+) <= n <= (\\S+)", "integer from $1 to $2"},
        {"A list of [01] to 4294967295 elements", "A list"},
        {"where each element is \\[Any (.*)\\]",
         "separated by commas, each any $1"},
        {"where each element is \\[A (.*)\\]",
         "separated by commas, each a $1"},
        {"Any [Ss]tring", any_text}};
      for (const auto &[pattern, replacement] : shorter)
        text = std::regex_replace(text, std::regex(pattern), replacement);
      text[0] = std::tolower(text[0]);
      return text;
    }

    void
    collect(const Tree                &tree,
            const std::string         &prefix,
            std::vector<ParameterKey> &keys,
            std::vector<std::string>  &sections)
    {
      for (const auto &[name, child] : tree)
        if (child.count("pattern_description") > 0)
          {
            const auto pattern = child.get<std::string>("pattern_description");
            keys.push_back({prefix + name,
                            child.get<std::string>("default_value"),
                            child.get<std::string>("documentation"),
                            noun_phrase(pattern),
                            pattern.find("[Double") != std::string::npos});
          }
        else
          {
            sections.push_back(prefix + name);
            collect(child, prefix + name + "/", keys, sections);
          }
    }

    /** deal.II's patterns of numbers match "inf" and "nan" as well. */
    bool
    all_finite(const std::string &numbers)
    {
      const auto list = Utilities::split_string_list(numbers);
      return std::all_of(list.begin(), list.end(), [](const std::string &text) {
        return std::isfinite(std::strtod(text.c_str(), nullptr));
      });
    }

    std::vector<std::string>
    split_path(const std::string &path)
    {
      std::vector<std::string> names;
      boost::split(names, path, boost::is_any_of("/"));
      return names;
    }

    /** Number of insertions, deletions and replacements (Levenshtein). */
    unsigned int
    edit_distance(const std::string &a, const std::string &b)
    {
      std::vector<unsigned int> row(b.size() + 1);
      std::iota(row.begin(), row.end(), 0u);
      for (std::size_t i = 0; i < a.size(); ++i)
        {
          unsigned int diagonal = row[0];
          row[0]                = i + 1;
          for (std::size_t j = 0; j < b.size(); ++j)
            {
              const unsigned int above = row[j + 1];
              row[j + 1]               = std::min(
                {above + 1, row[j] + 1, diagonal + (a[i] == b[j] ? 0u : 1u)});
              diagonal = above;
            }
        }
      return row.back();
    }

    /**
     * How unlike two paths are: the distance of the whole or, for a key that
     * stands in the wrong section, of the last name alone.
     */
    unsigned int
    unlikeness(const std::string &wanted, const std::string &candidate)
    {
      const std::string a = boost::to_lower_copy(wanted);
      const std::string b = boost::to_lower_copy(candidate);
      return std::min(2 * edit_distance(a, b),
                      2 * edit_distance(split_path(a).back(),
                                        split_path(b).back()) +
                        1);
    }

    /** A question, or empty if nothing is similar enough. */
    std::string
    did_you_mean(const std::string              &wanted,
                 const std::vector<std::string> &candidates)
    {
      if (candidates.empty() || wanted.size() > 200)
        return "";
      const auto best =
        std::min_element(candidates.begin(),
                         candidates.end(),
                         [&wanted](const std::string &a, const std::string &b) {
                           return unlikeness(wanted, a) < unlikeness(wanted, b);
                         });
      const std::size_t limit =
        std::max<std::size_t>(5, split_path(wanted).back().size());
      return unlikeness(wanted, *best) <= limit ?
               "Did you mean '" + *best + "'? " :
               "";
    }
  } // namespace


  ParameterKeys::ParameterKeys(const ParameterHandler &prm)
  {
    std::stringstream json;
    prm.print_parameters(json,
                         ParameterHandler::JSON |
                           ParameterHandler::KeepDeclarationOrder);
    Tree tree;
    boost::property_tree::read_json(json, tree);
    collect(tree, "", keys, sections);
  }


  const std::vector<ParameterKey> &
  ParameterKeys::list() const &
  {
    return keys;
  }


  bool
  ParameterKeys::has_section(const std::string &path) const
  {
    return std::find(sections.begin(), sections.end(), path) != sections.end();
  }


  void
  ParameterKeys::refuse_unknown(const Statement &statement) const
  {
    const std::string section =
      statement.path.substr(0, statement.path.rfind('/'));
    if (statement.kind == Statement::section)
      throw InputError(statement.place + statement.path,
                       "subsection",
                       "a section that exists",
                       did_you_mean(statement.path, sections) +
                         "'morula --parameters' prints them all.");
    std::vector<std::string> paths;
    for (const ParameterKey &key : keys)
      paths.push_back(key.path);
    throw InputError(statement.place + statement.path,
                     statement.value,
                     has_section(section) || section == statement.path ?
                       "a key that exists" :
                       "a key in a section that exists",
                     did_you_mean(statement.path, paths) +
                       "'morula --parameters' prints them all.");
  }


  void
  ParameterKeys::apply(const Statement &statement, ParameterHandler &prm) const
  {
    if (statement.kind == Statement::section)
      {
        if (!has_section(statement.path))
          refuse_unknown(statement);
        return;
      }
    const auto key = std::find_if(keys.begin(),
                                  keys.end(),
                                  [&statement](const ParameterKey &k) {
                                    return k.path == statement.path;
                                  });
    if (key == keys.end())
      refuse_unknown(statement);

    const auto refuse = [&] {
      throw InputError(statement.place + key->path,
                       statement.value,
                       key->allowed,
                       "It is: " + key->documentation +
                         " Correct the value or remove the line; the default "
                         "is '" +
                         key->default_value + "'.");
    };
    if (key->is_of_numbers && !all_finite(statement.value))
      refuse();
    const std::vector<std::string> names = split_path(key->path);
    for (std::size_t i = 0; i + 1 < names.size(); ++i)
      prm.enter_subsection(names[i]);
    try
      {
        prm.set(names.back(), statement.value);
      }
    catch (const std::exception &)
      {
        refuse();
      }
    for (std::size_t i = 0; i + 1 < names.size(); ++i)
      prm.leave_subsection();
  }


  void
  ParameterKeys::print(std::ostream &out) const
  {
    std::vector<std::string> open;
    const auto indent = [&open] { return std::string(2 * open.size(), ' '); };
    const auto leave  = [&] {
      open.pop_back();
      out << indent() << "end\n";
    };
    for (const ParameterKey &key : keys)
      {
        std::vector<std::string> names = split_path(key.path);
        const std::string        name  = names.back();
        names.pop_back();
        while (open.size() > names.size() ||
               !std::equal(open.begin(), open.end(), names.begin()))
          leave();
        out << '\n';
        while (open.size() < names.size())
          {
            out << indent() << "subsection " << names[open.size()] << '\n';
            open.push_back(names[open.size()]);
          }
        const std::string text =
          key.allowed == any_text ?
            key.documentation :
            key.documentation + " Allowed: " + key.allowed + ".";
        for (const std::string &line :
             Utilities::break_text_into_lines(text, 76 - 2 * open.size()))
          out << indent() << "# " << line << '\n';
        out << indent() << "set " << name << " = " << key.default_value << '\n';
      }
    while (!open.empty())
      leave();
  }
} // namespace Morula
