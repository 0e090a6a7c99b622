// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/fate/types_around.h>

#include <utility>

namespace Morula
{
  bool
  follows_types(const NeighbourVariable &told)
  {
    return told.kind == NeighbourVariable::count_of_type ||
           told.kind == NeighbourVariable::share_of_type ||
           told.kind == NeighbourVariable::unlike;
  }


  std::optional<double>
  of_types(const NeighbourVariable       &told,
           const unsigned int             own,
           const std::vector<CellBeside> &beside,
           const double                   surface)
  {
    if (!follows_types(told))
      return {};
    double sum = 0.;
    for (const CellBeside &cell : beside)
      {
        const bool counts = told.kind == NeighbourVariable::unlike ?
                              cell.type != own :
                              cell.type == told.number;
        if (counts)
          sum += told.kind == NeighbourVariable::count_of_type ? 1. : cell.area;
      }
    if (told.kind == NeighbourVariable::count_of_type)
      return sum;
    return surface > 0. ? sum / surface : 0.;
  }


  template <int dim>
  bool
  is_type_around(const Variable variable, const StateColumns<dim> &columns)
  {
    const unsigned int n = columns.n_before_neighbours();
    return is_field(variable) && field_number(variable) >= n &&
           follows_types(
             columns.neighbour_variables()[field_number(variable) - n]);
  }


  template <int dim>
  bool
  reads_types_around(const Expression        &expression,
                     const StateColumns<dim> &columns)
  {
    const auto &used = expression.used();
    return std::any_of(used.begin(), used.end(), [&](const Variable variable) {
      return is_type_around(variable, columns);
    });
  }


  template <int dim>
  TypesAround<dim>::TypesAround(const StateColumns<dim> &columns,
                                std::vector<CellBeside>  beside,
                                std::vector<Change>      changes,
                                const double             surface)
    : columns(columns)
    , beside(std::move(beside))
    , changes(std::move(changes))
    , surface(surface)
  {
    std::stable_sort(this->changes.begin(),
                     this->changes.end(),
                     [](const Change &a, const Change &b) {
                       return std::make_pair(a.time, !a.comes_first) <
                              std::make_pair(b.time, !b.comes_first);
                     });
  }


  template <int dim>
  void
  TypesAround<dim>::set(const CellView<dim, double> &row,
                        const std::size_t            k) const
  {
    std::vector<CellBeside> now = beside;
    for (std::size_t i = 0; i < k; ++i)
      now[changes[i].which].type = changes[i].type;
    const auto &told = columns.neighbour_variables();
    for (std::size_t v = 0; v < told.size(); ++v)
      if (const auto value =
            of_types(told[v], row.get(columns.type), now, surface))
        row.set(columns.neighbours[v], *value);
  }


  MORULA_INSTANTIATE(is_type_around);
  MORULA_INSTANTIATE(reads_types_around);
  template class TypesAround<2>;
  template class TypesAround<3>;
} // namespace Morula
