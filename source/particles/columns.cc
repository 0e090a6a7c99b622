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
    /** The columns of a layout: a line of it is a name and how many numbers. */
    std::map<std::string, std::string>
    columns_of(const std::string &layout)
    {
      std::map<std::string, std::string> columns;
      std::istringstream                 lines(layout);
      for (std::string name, n; lines >> name >> n;)
        columns[name + ' ' + n] = name;
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
    // The columns are compared by name, as users know them, and size. The order
    // matters as well, since a row is read by places.
    const auto  mine = columns_of(layout()), theirs = columns_of(other);
    std::string text;
    const auto  add =
      [&](const std::string &word, const auto &of, const auto &in) {
        for (const auto &[column, name] : of)
          if (in.count(column) == 0)
            text += (text.empty() ? "" : " and ") + word + " '" + name + "'";
      };
    add("lacks", mine, theirs);
    add("has", theirs, mine);
    return text.empty() && other != layout() ? "has them in another order" :
                                               text;
  }
} // namespace Morula
