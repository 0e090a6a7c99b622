// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/base/input_error.h>
#include <morula/base/name_list.h>
#include <morula/base/parameter_keys.h>

#include <deal.II/base/utilities.h>

#include <boost/algorithm/string.hpp>
#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ostream>
#include <regex>

namespace Morula
{
  namespace
  {
    /** deal.II's patterns of numbers match "inf" and "nan" as well. */
    bool
    // deal.II's patterns of numbers take these for numbers.
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

    /** A question about the first of the words that is no choice, or empty. */
    std::string
    did_you_mean(const std::string &value, const AnyKey &key)
    {
      const std::vector<std::string> choices = key.choices();
      for (const std::string &word : Utilities::split_string_list(value))
        if (std::find(choices.begin(), choices.end(), word) == choices.end())
          {
            const std::string best = most_similar(word, choices);
            return best.empty() ? "" : "Did you mean '" + best + "'? ";
          }
      return "";
    }

    /** What is allowed, also where any text is. */
    std::string
    allowed(const AnyKey &key)
    {
      const std::string phrase = key.allowed();
      return phrase.empty() ? "any text" : phrase;
    }

    /** A word on numbers with a decimal comma. */
    std::string
    on_comma(const std::string &value)
    {
      static const std::regex with_comma(
        "[-+]?[0-9]*,[0-9]+([eE][-+]?[0-9]+)?");
      return std::regex_match(value, with_comma) ?
               "Write decimals with a point. " :
               "";
    }

    /** A word on numbers with a unit. */
    std::string
    on_unit(const std::string &value)
    {
      static const std::regex with_unit(
        "[-+]?[0-9.]+([eE][-+]?[0-9]+)? *[^-+0-9.eE*/^ ,;()<>=&|][^ ]*");
      return std::regex_match(value, with_unit) ?
               "Write numbers without a unit. " :
               "";
    }
  } // namespace


  ParameterKeys::ParameterKeys(const KeyList &keys)
    : keys(keys)
  {
    // Every beginning of a path that ends at a slash is a section; each is
    // listed once, in the order of the keys.
    for (const AnyKey *key : keys)
      for (auto slash = key->path().find('/'); slash != std::string::npos;
           slash      = key->path().find('/', slash + 1))
        {
          const std::string section = key->path().substr(0, slash);
          if (!has_section(section))
            sections.push_back(section);
        }
  }


  AnyKey *
  ParameterKeys::find(const std::string &path) const
  {
    // Former names of a key go on to work.
    for (AnyKey *key : keys)
      {
        const auto &former = key->former_paths();
        if (key->path() == path ||
            std::find(former.begin(), former.end(), path) != former.end())
          return key;
      }
    return nullptr;
  }


  void
  ParameterKeys::refuse_unknown(const Statement &statement) const
  {
    // The field's word for a thing is the best help, then a similar name. A
    // name that exists outside of all sections tells of a missing 'end', the
    // most common mistake in long scenes.
    std::vector<std::string> paths;
    if (statement.is_section)
      paths = sections;
    else
      for (const AnyKey *key : keys)
        paths.push_back(key->path());
    const std::string name =
      statement.path.substr(statement.path.rfind('/') + 1);
    const std::vector<std::string> words      = words_of_keys(name);
    std::string                    suggestion = words.empty() ?
                                                  suggest_path(statement.path, paths) :
                                                  "For " + boost::to_lower_copy(name) + " see '" +
                                 boost::join(words, "' or '") + "'.";
    if (name != statement.path &&
        std::find(paths.begin(), paths.end(), name) != paths.end())
      suggestion += " Is an 'end' missing above?";
    if (!suggestion.empty())
      suggestion += ' ';
    throw InputError(
      printable(statement.place) +
      (statement.is_section ? "unknown section '" + printable(statement.path) :
                              "unknown key " + printable(statement.path) +
                                " = '" + printable(statement.value)) +
      "'. " + suggestion + "'morula keys WORD' finds keys by a word.");
  }


  void
  ParameterKeys::apply(const Statement &statement) const
  {
    // A section is only checked for being known; its keys come as statements of
    // their own. A value must match the pattern of its key, and numbers must be
    // finite. What converting it still throws is refused with the same words:
    // what the key means, what it allows, its default and unit.
    if (statement.is_section)
      {
        if (!has_section(statement.path))
          refuse_unknown(statement);
        return;
      }
    // It may be a former name.
    AnyKey *const key = find(statement.path);
    if (key == nullptr)
      refuse_unknown(statement);

    const auto refuse = [&] {
      const std::string unit = key->unit();
      throw InputError(statement.place + key->path(),
                       statement.value,
                       allowed(*key),
                       did_you_mean(statement.value, *key) +
                         on_comma(statement.value) + on_unit(statement.value) +
                         "Meaning: " + key->documentation() +
                         " Correct the value or remove the line; the default "
                         "is '" +
                         key->default_text() + "'" +
                         (unit.empty() ? "." : " " + unit + "."));
    };
    if ((key->is_of_numbers() && !all_finite(statement.value)) ||
        !key->pattern()->match(statement.value))
      refuse();
    try
      {
        key->assign(statement.value);
      }
    catch (const std::exception &)
      {
        refuse();
      }
  }


  void
  ParameterKeys::print(std::ostream &out) const
  {
    // The keys come section by section. Between two keys the sections that end
    // are closed and those that begin are opened. A key has its documentation
    // as a comment, with all that is not in the text of its value: limits,
    // former names, values that a Method sets. What is printed is a scene with
    // all defaults.
    std::vector<std::string> open;
    const auto indent = [&open] { return std::string(2 * open.size(), ' '); };
    const auto leave  = [&] {
      open.pop_back();
      out << indent() << "end\n";
    };
    for (const AnyKey *key : keys)
      {
        std::vector<std::string> names = split_path(key->path());
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
        const std::string phrase = key->allowed();
        const std::string text =
          phrase.empty() ? key->documentation() :
                           key->documentation() + " Allowed: " + phrase + ".";
        for (const std::string &line :
             // Lines end at the same column, whatever the depth.
             Utilities::break_text_into_lines(text, 76 - 2 * open.size()))
          out << indent() << "# " << line << '\n';
        for (const std::string &former : key->former_paths())
          out << indent() << "# Formerly: " << former << '\n';
        for (const auto &[method, value] : key->texts_by_method())
          out << indent() << "# With Method = " << method << ": " << value
              << '\n';
        out << indent() << "set " << name << " = " << key->default_text()
            << '\n';
      }
    while (!open.empty())
      leave();
  }


  namespace
  {
    template <typename T>
    bool
    is(const AnyKey &key)
    {
      return dynamic_cast<const Key<T> *>(&key) != nullptr;
    }

    /** What kind of value a key has. */
    std::string
    // The types are those that programs which write scenes need to tell apart.
    type_of(const AnyKey &key)
    {
      if (dynamic_cast<const ExpressionKey *>(&key) != nullptr)
        return "expression";
      if (key.names_file())
        return "file";
      if (is<double>(key))
        return "number";
      if (is<unsigned int>(key))
        return "integer";
      if (is<bool>(key))
        return "boolean";
      if (is<std::vector<double>>(key))
        return "list of numbers";
      if (is<std::vector<std::string>>(key))
        return "list of words";
      return key.choices().empty() ? "text" : "word";
    }

    /** The documentation without its last sentence, the unit. */
    std::string
    meaning_of(const AnyKey &key)
    {
      const std::string &all = key.documentation();
      return key.unit().empty() ?
               all :
               boost::trim_right_copy(all.substr(0, all.rfind("Units: ")));
    }

    std::string
    as_json(const AnyKey &key, const std::string *value)
    {
      // Members that do not apply to a key are left out.
      std::vector<std::pair<std::string, std::string>> members = {
        {"path", Json::text(key.path())},
        {"type", Json::text(type_of(key))},
        {"unit", Json::text(key.unit())},
        {"allowed", Json::text(key.allowed())},
        {"default", Json::text(key.default_text())},
        {"meaning", Json::text(meaning_of(key))}};
      if (value != nullptr)
        members.emplace_back("value", Json::text(*value));
      if (!key.choices().empty())
        members.emplace_back("choices", Json::texts(key.choices()));
      if (!key.texts_by_method().empty())
        {
          std::vector<std::pair<std::string, std::string>> texts;
          for (const auto &[method, text] : key.texts_by_method())
            texts.emplace_back(method, Json::text(text));
          members.emplace_back("default by method", Json::object(texts));
        }
      if (!key.former_paths().empty())
        members.emplace_back("formerly", Json::texts(key.former_paths()));
      if (const auto *expression = dynamic_cast<const ExpressionKey *>(&key))
        {
          members.emplace_back("components",
                               std::to_string(expression->components()));
          members.emplace_back(
            "evaluated", Json::text(description_of(expression->evaluated())));
          std::vector<std::string> variables;
          for (const Variable variable : variables_of(expression->evaluated()))
            variables.emplace_back(name_of(variable));
          members.emplace_back("variables", Json::texts(variables));
        }
      return Json::object(members);
    }
  } // namespace


  void
  ParameterKeys::print_json(
    std::ostream &out, const std::map<std::string, std::string> &values) const
  {
    std::vector<std::string> all;
    for (const AnyKey *key : keys)
      {
        const auto value = values.find(key->path());
        all.push_back(
          "\n " +
          as_json(*key, value == values.end() ? nullptr : &value->second));
      }
    out << Json::list(all) << '\n';
  }


  std::string
  Json::text(const std::string &value)
  {
    std::string quoted = "\"";
    // JSON wants quotes, backslashes and control characters in other words.
    for (const char c : value)
      if (c == '"' || c == '\\')
        quoted += std::string("\\") + c;
      else if (static_cast<unsigned char>(c) < 0x20)
        {
          char code[8];
          std::snprintf(code, sizeof(code), "\\u%04x", c);
          quoted += code;
        }
      else
        quoted += c;
    return quoted + '"';
  }


  std::string
  Json::number(const double value)
  {
    if (!std::isfinite(value))
      return "null";
    char digits[32];
    // 15 digits suffice for most numbers, 17 for all. The first that reads back
    // as the same number is the shortest.
    for (const int n : {15, 16, 17})
      {
        std::snprintf(digits, sizeof(digits), "%.*g", n, value);
        if (std::strtod(digits, nullptr) == value)
          break;
      }
    return digits;
  }


  std::string
  Json::texts(const std::vector<std::string> &values)
  {
    std::vector<std::string> quoted;
    for (const std::string &value : values)
      quoted.push_back(text(value));
    return list(quoted);
  }


  std::string
  Json::list(const std::vector<std::string> &values)
  {
    return "[" + boost::join(values, ", ") + "]";
  }


  std::string
  Json::object(const std::vector<std::pair<std::string, std::string>> &members)
  {
    std::vector<std::string> pairs;
    for (const auto &[name, value] : members)
      pairs.push_back(text(name) + ": " + value);
    return "{" + boost::join(pairs, ", ") + "}";
  }
} // namespace Morula
