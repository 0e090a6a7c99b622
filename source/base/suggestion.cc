// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/suggestion.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <iterator>
#include <numeric>

namespace Morula
{
  namespace
  {
    /** Characters. A longer word is no misspelt name, and its table would be
     *  large. */
    constexpr std::size_t longest_word = 200;

    std::string
    last_name(const std::string &path)
    {
      return path.substr(path.rfind('/') + 1);
    }
  } // namespace


  unsigned int
  edit_distance(const std::string &a, const std::string &b)
  {
    // Three rows of the table of distances between the beginnings of both texts
    // are enough: rows i - 1, i and i + 1.
    std::vector<unsigned int> before(b.size() + 1), row(b.size() + 1),
      next(b.size() + 1);
    std::iota(row.begin(), row.end(), 0u);
    for (std::size_t i = 0; i < a.size(); ++i)
      {
        next[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j)
          {
            next[j + 1] = std::min(
              {row[j + 1] + 1, next[j] + 1, row[j] + (a[i] == b[j] ? 0u : 1u)});
            // Two letters that were swapped count once.
            if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
              next[j + 1] = std::min(next[j + 1], before[j - 1] + 1);
          }
        before.swap(row);
        row.swap(next);
      }
    return row.back();
  }


  std::string
  most_similar(const std::string              &word,
               const std::vector<std::string> &candidates)
  {
    std::string best;
    if (word.size() > longest_word)
      return best;
    // At most a third of the letters may differ, at least one, but never all.
    unsigned int limit = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string &candidate : candidates)
      {
        const unsigned int distance =
          edit_distance(boost::to_lower_copy(word),
                        boost::to_lower_copy(candidate));
        if (distance < limit && distance < candidate.size())
          {
            limit = distance;
            best  = candidate;
          }
      }
    return best;
  }


  std::string
  suggest_path(const std::string              &wanted,
               const std::vector<std::string> &candidates)
  {
    // First comes a path that is spelt nearly so and ends with the same name.
    // Then the same name in any other section, of which there may be several.
    // Then a path that is spelt nearly so at all.
    const std::string        best = most_similar(wanted, candidates);
    std::vector<std::string> found;
    if (boost::iequals(last_name(best), last_name(wanted)))
      found = {best};
    else
      std::copy_if(candidates.begin(),
                   candidates.end(),
                   std::back_inserter(found),
                   [&](const std::string &candidate) {
                     return boost::iequals(last_name(candidate),
                                           last_name(wanted));
                   });
    if (found.empty() && !best.empty())
      found = {best};
    return found.empty() ?
             "" :
             "Did you mean '" + boost::join(found, "' or '") + "'?";
  }
} // namespace Morula
