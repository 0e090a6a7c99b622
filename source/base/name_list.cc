// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_parser.h>
#include <morula/base/input_error.h>
#include <morula/base/name_list.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cctype>
#include <set>

namespace Morula
{
  std::vector<std::string>
  split_names(const std::string &text)
  {
    std::vector<std::string> names;
    // An empty text has no names, rather than one that is empty.
    if (boost::trim_copy(text).empty())
      return names;
    boost::split(names, text, boost::is_any_of(","));
    for (std::string &name : names)
      boost::trim(name);
    return names;
  }


  std::string
  reason_against_section(const std::string &name)
  {
    const bool plain =
      !name.empty() && std::all_of(name.begin(), name.end(), [](const char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
      });
    return plain ? "" : "Names have letters, digits and '_'.";
  }


  std::string
  reason_against_variable(const std::string &name)
  {
    if (!reason_against_section(name).empty() ||
        !std::isalpha(static_cast<unsigned char>(name[0])))
      return "Names have letters, digits and '_', and begin with a letter.";
    if (!is_free_name(name))
      return "Expressions have a variable or function of this name: choose "
             "another one.";
    return "";
  }


  std::vector<std::string>
  declared_names(
    const AnyKey                                          &key,
    const std::string                                     &text,
    const std::function<std::string(const std::string &)> &reason_against)
  {
    // A name is refused for a reason of its own, or because it is there twice.
    const std::vector<std::string> list = split_names(text);
    std::set<std::string>          seen;
    for (const std::string &name : list)
      {
        const std::string reason = reason_against(name);
        if (!reason.empty() || !seen.insert(name).second)
          throw InputError(key.path(),
                           text,
                           "names that differ, separated by commas",
                           "'" + name + "': " +
                             (reason.empty() ? "it is there twice." : reason));
      }
    return list;
  }


  void
  place_in(const KeyList &keys, const std::string &section)
  {
    for (AnyKey *key : keys)
      key->place_in(section);
  }
} // namespace Morula
