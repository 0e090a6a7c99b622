// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_suggestion_h
#define morula_base_suggestion_h

#include <string>
#include <vector>

namespace Morula
{
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
