// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/base/json.h>
#include <morula/base/parameter_keys.h>

#include <boost/algorithm/string.hpp>

#include <ostream>

namespace Morula
{
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
    as_json(const AnyKey &key)
    {
      // Members that do not apply to a key are left out.
      std::vector<std::pair<std::string, std::string>> members = {
        {"path", Json::text(key.path())},
        {"type", Json::text(type_of(key))},
        {"unit", Json::text(key.unit())},
        {"allowed", Json::text(key.allowed())},
        {"default", Json::text(key.default_text())},
        {"meaning", Json::text(meaning_of(key))}};
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
  ParameterKeys::print_json(std::ostream &out) const
  {
    std::vector<std::string> all;
    for (const AnyKey *key : keys)
      all.push_back("\n " + as_json(*key));
    out << Json::list(all) << '\n';
  }
} // namespace Morula
