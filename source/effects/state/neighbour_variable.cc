// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/state/neighbour_variable.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace Morula
{
  namespace
  {
    /** The names that end with that of something else. */
    struct Prefix
    {
      const char             *text;
      NeighbourVariable::Kind kind;
    };

    constexpr std::array<Prefix, 4> prefixes = {
      {{"neighbours_", NeighbourVariable::count_of_type},
       {"touching_", NeighbourVariable::share_of_type},
       {"around_", NeighbourVariable::around},
       {"slope_", NeighbourVariable::slope}}};

    /** The place of a name in a list, or none. */
    std::optional<unsigned int>
    place_in(const std::vector<std::string> &list, const std::string &name)
    {
      const auto found = std::find(list.begin(), list.end(), name);
      if (found == list.end())
        return {};
      return std::distance(list.begin(), found);
    }

    /** The variable that a name behind "around_" is, or none. */
    std::optional<Variable>
    variable_of(const std::string &name, const std::vector<std::string> &fields)
    {
      // X, Y, Z and t need no mean: they are no state of a cell.
      for (unsigned int i = static_cast<unsigned int>(Variable::x);
           i < n_variables;
           ++i)
        if (name == name_of(static_cast<Variable>(i)))
          return static_cast<Variable>(i);
      if (const auto k = place_in(fields, name))
        return field_variable(*k);
      return {};
    }
  } // namespace


  std::optional<NeighbourVariable>
  neighbour_variable(const std::string              &name,
                     const std::vector<std::string> &types,
                     const std::vector<std::string> &fields)
  {
    // A type or field of this name is older, and keeps it.
    if (place_in(types, name) || place_in(fields, name))
      return {};
    if (name == "neighbours")
      return NeighbourVariable{name, NeighbourVariable::count};
    if (name == "unlike")
      return NeighbourVariable{name, NeighbourVariable::unlike};
    if (name == "free")
      return NeighbourVariable{name, NeighbourVariable::free};
    for (const auto &[text, kind] : prefixes)
      {
        if (name.rfind(text, 0) != 0)
          continue;
        const std::string rest = name.substr(std::string(text).size());
        if (kind == NeighbourVariable::around)
          {
            if (const auto variable = variable_of(rest, fields))
              return NeighbourVariable{name, kind, 0, *variable};
          }
        else if (const auto number =
                   place_in(kind == NeighbourVariable::slope ? fields : types,
                            rest))
          return NeighbourVariable{name, kind, *number};
      }
    return {};
  }


  bool
  tells_of_neighbours(const std::string &name)
  {
    return std::any_of(prefixes.begin(),
                       prefixes.end(),
                       [&](const auto &prefix) {
                         return name.rfind(prefix.text, 0) == 0;
                       });
  }
} // namespace Morula
