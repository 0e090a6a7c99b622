// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_name_list_h
#define morula_base_name_list_h

#include <morula/base/key.h>

#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  /** The names in a comma-separated list, without blanks around them. */
  std::vector<std::string>
  split_names(const std::string &text);

  /** Why a section cannot have this name; empty if it can. */
  std::string
  reason_against_section(const std::string &name);

  /** Why a name cannot stand in an expression; empty if it can. */
  std::string
  reason_against_variable(const std::string &name);

  /**
   * The names in the text of a key that declares sections.
   * @param reason_against why a name cannot be taken; empty if it can
   * @throws InputError for such a name, and for one that is there twice
   */
  std::vector<std::string>
  declared_names(
    const AnyKey                                          &key,
    const std::string                                     &text,
    const std::function<std::string(const std::string &)> &reason_against);

  /** Puts keys into a section: "Key" becomes "Section/Key". */
  void
  place_in(const KeyList &keys, const std::string &section);

  /** The key that names sections, and those of the sections. */
  template <typename Sections>
  KeyList
  keys_of_all(AnyKey &names, Sections &sections)
  {
    KeyList list{&names};
    for (auto &section : sections)
      for (AnyKey *key : section.list())
        list.push_back(key);
    return list;
  }

  /** The names of sections. */
  template <typename Sections>
  std::vector<std::string>
  names_of(const Sections &sections)
  {
    std::vector<std::string> list;
    for (const auto &section : sections)
      list.push_back(section.name);
    return list;
  }
} // namespace Morula

#endif
