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


  /**
   * The smallest number of insertions, deletions, replacements and swaps of two
   * neighbours that turn one text into the other (optimal string alignment).
   * Neither Boost 1.74 nor deal.II has an edit distance.
   */
  unsigned int
  edit_distance(const std::string &a, const std::string &b);

  /**
   * The candidate that the misspelt word most likely stands for; empty if no
   * candidate is similar. Upper and lower case count as equal.
   */
  std::string
  most_similar(const std::string              &word,
               const std::vector<std::string> &candidates);

  /**
   * What keys call a thing that has this name in the field, e.g. "Consumption"
   * for "uptake": parts of their paths. Empty if that is no other word.
   */
  std::vector<std::string>
  words_of_keys(const std::string &name);

  /** The name of a key, or a word of words_of_keys(), that a misspelt word most
   *  likely stands for; or empty. */
  std::string
  similar_word(const std::string &word);

  /**
   * A suggestion for the full path of a key or section that does not exist: the
   * most similar path, or those that end with the same name. Empty if nothing
   * is similar.
   * @param wanted     path, separated by '/'
   * @param candidates paths that exist
   */
  std::string
  suggest_path(const std::string              &wanted,
               const std::vector<std::string> &candidates);
} // namespace Morula

#endif
