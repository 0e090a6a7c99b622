// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/neighbour_histories.h>
#include <morula/particles/point_exchange.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <unordered_map>

namespace Morula
{
  namespace
  {
    /** Whether some variable is of this kind. */
    template <int dim>
    bool
    uses(const StateColumns<dim> &columns, const NeighbourVariable::Kind kind)
    {
      const auto &told = columns.neighbour_variables();
      return std::any_of(told.begin(),
                         told.end(),
                         [kind](const NeighbourVariable &variable) {
                           return variable.kind == kind;
                         });
    }
  } // namespace


  template <int dim>
  typename NeighbourHistories<dim>::History
  NeighbourHistories<dim>::history_of(const std::vector<CellEvent> &events)
  {
    History history;
    for (const CellEvent &event : events)
      if (event.kind == CellEvent::transition)
        history.push_back({event.time, event.to});
    return history;
  }


  template <int dim>
  NeighbourHistories<dim>::NeighbourHistories(
    const Tissue<dim>            &tissue,
    const StateColumns<dim>      &columns,
    const NeighbourSearch        &search,
    const std::vector<CellEvent> &events)
    : tissue(tissue)
    , columns(columns)
    , search(search)
    , sees_itself(uses(columns, NeighbourVariable::unlike))
  {
    if (events.empty())
      return;
    std::unordered_map<types::particle_index, unsigned int> own;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      own[tissue.cells().id(p)] = p;
    for (const CellEvent &event : events)
      events_of[own.at(event.id)].push_back(event);
    for (const auto &[p, of_cell] : events_of)
      if (const History history = history_of(of_cell); !history.empty())
        {
          histories[p] = history;
          changed.push_back(p);
        }
  }


  template <int dim>
  void
  NeighbourHistories<dim>::find_neighbours()
  {
    // Own cells are the first points of the graph, so that their numbers are
    // the same.
    const Cells<dim> &cells = tissue.cells();
    PointList<dim>    points(1);
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const double type = cells[p].get(columns.type);
        points.add(cells.id(p),
                   cells.position(p),
                   ArrayView<const double>(&type, 1));
      }
    graph = neighbours(tissue, points, search);
    if (sees_itself || uses(columns, NeighbourVariable::share_of_type))
      free = free_surfaces(tissue);
    beside_of.resize(graph.points.size());
    for (unsigned int p = 0; p < graph.n_own; ++p)
      graph.for_neighbours(p, [&](const auto &edge) {
        beside_of[edge.other].push_back(p);
        if (edge.other >= graph.n_own)
          point_of[graph.points.ids[edge.other]] = edge.other;
      });
    found = true;
  }


  template <int dim>
  bool
  NeighbourHistories<dim>::exchange()
  {
    // Neighbours are looked for only in steps in which some cell changes its
    // type. A cell that has changed is told with all its changes, or with one
    // that says that there is none.
    const MPI_Comm comm = tissue.communicator();
    again.clear();
    if (Utilities::MPI::sum(changed.size(), comm) == 0)
      return false;
    if (!found)
      find_neighbours();
    constexpr double no_type = -1.;
    PointList<dim>   told(2);
    const auto       tell =
      [&](const unsigned int p, const double time, const double type) {
        const std::array<double, 2> row = {{time, type}};
        told.add(tissue.cells().id(p),
                 tissue.cells().position(p),
                 ArrayView<const double>(row.data(), row.size()));
      };
    for (const unsigned int p : changed)
      {
        const History &history = histories[p];
        for (const Change &change : history)
          tell(p, change.time, change.type);
        if (history.empty())
          tell(p, 0., no_type);
      }
    std::map<unsigned int, History> heard;
    const PointList<dim> others = halo(told, tissue.grid(), graph.longest);
    for (std::size_t i = 0; i < others.size(); ++i)
      if (const auto point = point_of.find(others.ids[i]);
          point != point_of.end())
        {
          History     &history = heard[point->second];
          const double type    = others.row(i)[1];
          if (type != no_type)
            history.push_back(
              {others.row(i)[0], static_cast<unsigned int>(type)});
        }
    for (const auto &[point, history] : heard)
      {
        histories[point] = history;
        changed.push_back(point);
      }
    for (const unsigned int point : changed)
      {
        again.insert(again.end(),
                     beside_of[point].begin(),
                     beside_of[point].end());
        if (sees_itself && point < graph.n_own)
          again.push_back(point);
      }
    changed.clear();
    std::sort(again.begin(), again.end());
    again.erase(std::unique(again.begin(), again.end()), again.end());
    return Utilities::MPI::sum(again.size(), comm) > 0;
  }


  template <int dim>
  TypesAround<dim>
  NeighbourHistories<dim>::around(const unsigned int p) const
  {
    // Of two events at the same time that of the cell with the lower id comes
    // first.
    std::vector<CellBeside>                        beside;
    std::vector<typename TypesAround<dim>::Change> changes;
    double surface = free.empty() ? 0. : free[p];
    graph.for_neighbours(p, [&](const auto &edge) {
      if (const auto history = histories.find(edge.other);
          history != histories.end())
        for (const Change &change : history->second)
          changes.push_back(
            {change.time,
             static_cast<unsigned int>(beside.size()),
             change.type,
             graph.points.ids[edge.other] < graph.points.ids[p]});
      surface += edge.area;
      beside.push_back(
        {static_cast<unsigned int>(graph.points.row(edge.other)[0]),
         edge.area});
    });
    return {columns, std::move(beside), std::move(changes), surface};
  }


  template <int dim>
  void
  NeighbourHistories<dim>::set(const unsigned int            p,
                               const std::vector<CellEvent> &events)
  {
    events_of[p]          = events;
    const History history = history_of(events);
    if (history == histories[p])
      return;
    histories[p] = history;
    changed.push_back(p);
  }


  template <int dim>
  std::vector<CellEvent>
  NeighbourHistories<dim>::events() const
  {
    std::vector<CellEvent> list;
    for (const auto &[p, of_cell] : events_of)
      list.insert(list.end(), of_cell.begin(), of_cell.end());
    return list;
  }


  template class NeighbourHistories<2>;
  template class NeighbourHistories<3>;
} // namespace Morula
