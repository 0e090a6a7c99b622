// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// without this, json_parser.hpp of Boost 1.74 prints a note about placeholders
#define BOOST_BIND_GLOBAL_PLACEHOLDERS

#include <morula/base/input_error.h>
#include <morula/base/method.h>
#include <morula/base/parameter_keys.h>
#include <morula/base/suggestion.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <boost/algorithm/string.hpp>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
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

    /** The words among which a key's value, or each of its list, is chosen. */
    std::vector<std::string>
    choices_of(const std::string &machine_description)
    {
      if (machine_description.find("[Bool]") != std::string::npos)
        return {"true", "false"};
      std::vector<std::string> words;
      std::smatch              match;
      if (std::regex_search(machine_description,
                            match,
                            std::regex("\\[Selection ([^\\]]*)\\]")))
        boost::split(words,
                     boost::trim_copy(match[1].str()),
                     boost::is_any_of("|"));
      return words;
    }

    /** A question about the first of the words that is no choice, or empty. */
    std::string
    did_you_mean(const std::string &value, const ParameterKey &key)
    {
      for (const std::string &word : Utilities::split_string_list(value))
        if (std::find(key.choices.begin(), key.choices.end(), word) ==
            key.choices.end())
          {
            const std::string best = most_similar(word, key.choices);
            return best.empty() ? "" : "Did you mean '" + best + "'? ";
          }
      return "";
    }

    /** What follows "Units: " at the end of a documentation. */
    std::string
    unit_of(const std::string &documentation)
    {
      const std::string word  = "Units: ";
      const auto        begin = documentation.rfind(word);
      return begin == std::string::npos ?
               "" :
               boost::trim_right_copy_if(documentation.substr(begin +
                                                              word.size()),
                                         boost::is_any_of("."));
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
    const std::function<void(const Tree &, const std::string &)> collect =
      [&](const Tree &branch, const std::string &prefix) {
        for (const auto &[name, child] : branch)
          if (child.count("pattern_description") > 0)
            {
              const auto pattern =
                child.get<std::string>("pattern_description");
              const auto documentation =
                child.get<std::string>("documentation");
              keys.push_back({prefix + name,
                              child.get<std::string>("default_value"),
                              documentation,
                              noun_phrase(pattern),
                              unit_of(documentation),
                              choices_of(pattern),
                              pattern.find("[Double") != std::string::npos});
            }
          else if (child.count("alias") > 0)
            renamed[prefix + name] = prefix + child.get<std::string>("alias");
          else
            {
              sections.push_back(prefix + name);
              collect(child, prefix + name + "/");
            }
      };
    collect(tree, "");
  }


  const std::vector<ParameterKey> &
  ParameterKeys::list() const &
  {
    return keys;
  }


  std::string
  ParameterKeys::current_name(const std::string &path) const
  {
    const auto found = renamed.find(path);
    return found == renamed.end() ? path : found->second;
  }


  bool
  ParameterKeys::has_section(const std::string &path) const
  {
    return std::find(sections.begin(), sections.end(), path) != sections.end();
  }


  std::string
  ParameterKeys::missing_end(const Statement &statement) const
  {
    const std::vector<std::string> names = split_path(statement.path);
    // Names may have a slash in them, by mistake; and -s has no subsections.
    if (names.size() !=
        statement.around.size() + (statement.kind == Statement::set ? 1 : 0))
      return "";
    for (std::size_t n = names.size() - 1; n-- > 0;)
      {
        const std::vector<std::string> outer(names.begin(), names.begin() + n);
        const std::string              path =
          boost::join(outer, "/") + (n > 0 ? "/" : "") + names.back();
        const bool known =
          statement.kind == Statement::section ?
            has_section(path) :
            std::any_of(keys.begin(), keys.end(), [&](const ParameterKey &key) {
              return key.path == current_name(path);
            });
        if (known)
          return "'subsection " + names[n] + "' of " + statement.around[n] +
                 " is still open here: is an 'end' missing? ";
      }
    return "";
  }


  void
  ParameterKeys::refuse_unknown(const Statement &statement) const
  {
    const std::string section =
      statement.path.substr(0, statement.path.rfind('/'));
    const bool               is_section = statement.kind == Statement::section;
    std::vector<std::string> paths;
    if (is_section)
      paths = sections;
    else
      for (const ParameterKey &key : keys)
        paths.push_back(key.path);
    std::string suggestion = suggest_path(statement.path, paths);
    if (!suggestion.empty())
      suggestion += ' ';
    if (const std::string open = missing_end(statement); !open.empty())
      suggestion = open;
    throw InputError(statement.place +
                       (is_section ? "subsection" : statement.path),
                     is_section ? statement.path : statement.value,
                     is_section ? "a section that exists" :
                     has_section(section) || section == statement.path ?
                                  "a key that exists" :
                                  "a key in a section that exists",
                     suggestion + "'morula --parameters' prints them all.");
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
    const auto key =
      std::find_if(keys.begin(),
                   keys.end(),
                   [this, &statement](const ParameterKey &k) {
                     return k.path == current_name(statement.path);
                   });
    if (key == keys.end())
      refuse_unknown(statement);

    const auto refuse = [&] {
      throw InputError(statement.place + key->path,
                       statement.value,
                       key->allowed,
                       did_you_mean(statement.value, *key) +
                         "It is: " + key->documentation +
                         " Correct the value or remove the line; the default "
                         "is '" +
                         key->default_value + "'" +
                         (key->unit.empty() ? "." : " " + key->unit + "."));
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
        for (const auto &[old, path] : renamed)
          if (path == key.path)
            out << indent() << "# Formerly: " << old << '\n';
        for (const auto &[path, value] : Method::values("consistent"))
          if (path == key.path)
            out << indent() << "# With Method = consistent: " << value << '\n';
        out << indent() << "set " << name << " = " << key.default_value << '\n';
      }
    while (!open.empty())
      leave();
  }
} // namespace Morula
