// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/suggestion.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
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

    /** "subsection Grid", or the words for the place outside all subsections.
     */
    std::string
    place_of(const std::string &path)
    {
      const auto slash = path.rfind('/');
      return slash == std::string::npos ?
               "outside all subsections" :
               "in subsection " + path.substr(0, slash);
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
    // Then a path that is spelt nearly so at all, and at last a name that is.
    if (const std::string best = most_similar(wanted, candidates);
        !best.empty() && boost::iequals(last_name(best), last_name(wanted)))
      return "Did you mean '" + best + "'?";

    std::vector<std::string> places;
    std::string              elsewhere;
    for (const std::string &candidate : candidates)
      if (boost::iequals(last_name(candidate), last_name(wanted)))
        {
          places.push_back(place_of(candidate));
          elsewhere += (elsewhere.empty() ? "'" : " or '") + candidate + "'";
        }
    if (!places.empty())
      return "Did you mean " + elsewhere + "? That name stands " +
             boost::join(places, ", and ") + ".";

    if (const std::string best = most_similar(wanted, candidates);
        !best.empty())
      return "Did you mean '" + best + "'?";

    std::vector<std::string> names;
    for (const std::string &candidate : candidates)
      names.push_back(last_name(candidate));
    const std::string name = most_similar(last_name(wanted), names);
    const auto        found =
      std::find(names.begin(), names.end(), name) - names.begin();
    return name.empty() ?
             "" :
             "Did you mean '" + candidates[found] + "'? That name stands " +
               place_of(candidates[found]) + ".";
  }
} // namespace Morula
