// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_suggestion_h
#define morula_base_suggestion_h

#include <string>
#include <vector>

namespace Morula
{
  /**
   * Number of insertions, deletions, replacements and swaps of two neighbours
   * that make one text of the other (optimal string alignment). Neither Boost
   * 1.74 nor deal.II has an edit distance.
   */
  unsigned int
  edit_distance(const std::string &a, const std::string &b);

  /**
   * The candidate that the misspelt word most likely stands for, in upper or
   * lower case; empty if none is similar.
   */
  std::string
  most_similar(const std::string              &word,
               const std::vector<std::string> &candidates);

  /**
   * What to say about the full path of a key or section that does not exist:
   * the most similar one, or the sections where its last name stands; empty if
   * nothing is similar.
   * @param wanted     path, separated by '/'
   * @param candidates paths that exist
   */
  std::string
  suggest_path(const std::string              &wanted,
               const std::vector<std::string> &candidates);
} // namespace Morula

#endif
