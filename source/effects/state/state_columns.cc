// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/state/state_columns.h>

#include <array>
#include <iterator>

// Effects say in their constructors which variables their expressions read. The
// columns are declared after all of them are made, and only those that
// something reads.

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
    variable_of(const std::string &name, const std::vector<std::string> &own)
    {
      // X, Y, Z and t need no mean: they are no state of a cell.
      for (unsigned int i = static_cast<unsigned int>(Variable::x);
           i < n_variables;
           ++i)
        if (name == name_of(static_cast<Variable>(i)))
          return static_cast<Variable>(i);
      if (const auto k = place_in(own, name))
        return field_variable(*k);
      return {};
    }
  } // namespace


  std::optional<NeighbourVariable>
  neighbour_variable(const std::string              &name,
                     const std::vector<std::string> &types,
                     const std::vector<std::string> &own,
                     const unsigned int              n_fields)
  {
    // A type, field or number of this name is older, and keeps it.
    if (place_in(types, name) || place_in(own, name))
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
            if (const auto variable = variable_of(rest, own))
              return NeighbourVariable{name, kind, 0, *variable};
          }
        else if (const bool slopes = kind == NeighbourVariable::slope;
                 const auto number = place_in(slopes ? own : types, rest))
          {
            if (!slopes || *number < n_fields)
              return NeighbourVariable{name, kind, *number};
          }
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


  template <int dim>
  StateColumns<dim>::StateColumns(
    const std::vector<std::string>       &types,
    const std::vector<std::string>       &fields,
    const std::vector<std::string>       &numbers,
    const std::vector<NeighbourVariable> &neighbours)
    : carried(fields.size(), false)
    , types(types)
    , names_of_fields(fields)
    , names_of_numbers(numbers)
    , of_neighbours(neighbours)
    , needs_gradient(fields.size(), false)
  {
    // A variable of neighbours may itself read others of each cell.
    for (const NeighbourVariable &told : of_neighbours)
      if (told.kind == NeighbourVariable::slope)
        needs_gradient[told.number] = true;
      else if (told.kind == NeighbourVariable::around)
        need(told.variable);
  }


  template <int dim>
  void
  StateColumns<dim>::declare_fields(CellColumns<dim> &columns)
  {
    // Each field has a column, as its value belongs to the cell and moves with
    // it. The gradient is computed once a step and stored only where a
    // direction reads it.
    gradients.resize(names_of_fields.size());
    for (unsigned int k = 0; k < names_of_fields.size(); ++k)
      {
        const std::string &name = names_of_fields[k];
        fields.push_back(columns.template add<double>(
          {name, "", "the field " + name, 0., AtDivision::copied, true}));
        if (needs_gradient[k])
          gradients[k] = columns.template add<Tensor<1, dim>>(
            {name + "_gradient", "1/um", "gradient of the field " + name});
      }
  }


  template <int dim>
  void
  StateColumns<dim>::declare(CellColumns<dim> &columns)
  {
    // Times are stored instead of ages, so that a column changes only at an
    // event. Depth and normal are taken once at t = 0 and inherited by all
    // descendants.
    const auto add = [&columns](const std::string &name,
                                const std::string &unit,
                                const std::string &meaning,
                                const bool         in_output) {
      return columns.template add<double>(
        {name, unit, meaning, 0., AtDivision::copied, in_output});
    };
    if (uses(Variable::type_age))
      type_since =
        add("type_since", "day", "when the cell got its type", false);
    if (uses(Variable::age))
      birth_time = add("birth_time", "day", "when the cell was born", false);
    if (uses(Variable::depth))
      depth = add("depth",
                  "um",
                  "distance of the founder from the surface at t = 0",
                  true);
    // The effects that are the owners of numbers have declared them.
    for (const std::string &name : names_of_numbers)
      numbers.push_back(columns.template find<double>(name));
    for (const NeighbourVariable &told : of_neighbours)
      neighbours.push_back(
        told.kind == NeighbourVariable::slope ?
          Column<double>() :
          add(told.name, "", "what it says of the cell's neighbours", true));
    if (uses(Variable::present_depth))
      present_depth = add("present_depth",
                          "um",
                          "distance of the cell from the surface",
                          true);
    if (needs_normal)
      surface_normal = columns.template add<Tensor<1, dim>>(
        {"surface_normal", "", "of the surface near the founder, at t = 0"});
  }


  template class StateColumns<2>;
  template class StateColumns<3>;
} // namespace Morula
