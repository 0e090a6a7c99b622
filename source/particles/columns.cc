// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/columns.h>

#include <map>
#include <sstream>
#include <stdexcept>

namespace Morula
{
  namespace
  {
    /** How many numbers each column of a layout has. */
    std::map<std::string, unsigned int>
    sizes(const std::string &layout)
    {
      // A line of a layout is a name and a number.
      std::map<std::string, unsigned int> columns;
      std::istringstream                  lines(layout);
      std::string                         name;
      for (unsigned int n = 0; lines >> name >> n;)
        columns[name] = n;
      return columns;
    }
  } // namespace

  void
  Columns::check_name(const std::string &name) const
  {
    if (name.empty() ||
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz"
                               "0123456789_") != std::string::npos)
      throw std::invalid_argument("The column '" + name +
                                  "' must be called by small letters, digits "
                                  "and '_'.");
    for (const Entry &entry : list)
      if (entry.name == name)
        throw std::invalid_argument("There are two columns '" + name +
                                    "': every effect must give its columns "
                                    "names of their own.");
  }

  std::vector<double>
  Columns::daughter(const ArrayView<const double> &mother) const
  {
    AssertDimension(mother.size(), n_numbers());
    std::vector<double> row(mother.begin(), mother.end());
    for (const Entry &entry : list)
      for (unsigned int i = entry.first; i < entry.first + entry.n; ++i)
        // Each number of the row follows the rule of its column: halved, reset
        // to a founder's value, or copied as it stands.
        if (entry.at_division == AtDivision::halved)
          row[i] *= 0.5;
        else if (entry.at_division == AtDivision::reset)
          row[i] = initial[i];
    return row;
  }

  std::string
  Columns::layout() const
  {
    std::string text;
    for (const Entry &entry : list)
      text += entry.name + ' ' + std::to_string(entry.n) + '\n';
    return text;
  }

  std::string
  Columns::differences(const std::string &other) const
  {
    // The columns are compared by name, as users know them. The order matters
    // as well, since a row is read by places.
    const std::map<std::string, unsigned int> mine   = sizes(layout());
    const std::map<std::string, unsigned int> theirs = sizes(other);
    std::vector<std::string>                  parts;
    for (const auto &[name, n] : mine)
      if (theirs.count(name) == 0)
        parts.push_back("lacks '" + name + "'");
      else if (theirs.at(name) != n)
        parts.push_back("has '" + name + "' of " +
                        std::to_string(theirs.at(name)) + " numbers, not " +
                        std::to_string(n));
    for (const auto &column : theirs)
      if (mine.count(column.first) == 0)
        parts.push_back("has '" + column.first + "'");
    if (parts.empty() && other != layout())
      return "has them in another order";
    std::string text;
    for (const std::string &part : parts)
      text += (text.empty() ? "" : " and ") + part;
    return text;
  }
} // namespace Morula
