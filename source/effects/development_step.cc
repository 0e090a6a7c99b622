// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/development.h>
#include <morula/effects/state/neighbour_columns.h>
#include <morula/particles/cell_event.h>
#include <morula/particles/neighbours.h>
#include <morula/particles/point_exchange.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>
#include <unordered_map>
#include <vector>

// This file lets all cells develop through a step.

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

    /**
     * What the events of a step do to the types of cells, as the cells beside
     * them see it: doc/theory.md, section 12.1. The neighbours are those at the
     * beginning of the step.
     */
    template <int dim>
    class NeighbourHistories
    {
    public:
      /** @param events of this rank's cells, as if nobody saw the others.
       * Refers to the tissue and its columns, which must outlive it.
       * Collective. */
      NeighbourHistories(const Tissue<dim>            &tissue,
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

      /** Tells all ranks what has changed since the last call. @return whether
       *  some cell of some rank has to live again. Collective. */
      bool
      exchange()
      {
        // Neighbours are looked for only in steps in which some cell changes
        // its type. A cell that has changed is told with all its changes, or
        // with one that says that there is none.
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

      /** The cells of this rank that have to, since the last exchange(). */
      const std::vector<unsigned int> &
      to_live_again() const
      {
        return again;
      }

      /** The types beside cell @p p of this rank. */
      TypesAround<dim>
      around(const unsigned int p) const
      {
        // Of two events at the same time that of the cell with the lower id
        // comes first.
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

      /** The events of cell @p p of this rank have come out so. */
      void
      set(const unsigned int p, const std::vector<CellEvent> &events)
      {
        events_of[p]          = events;
        const History history = history_of(events);
        if (history == histories[p])
          return;
        histories[p] = history;
        changed.push_back(p);
      }

      /** All events of this rank's cells, in the order of the cells. */
      std::vector<CellEvent>
      events() const
      {
        std::vector<CellEvent> list;
        for (const auto &[p, of_cell] : events_of)
          list.insert(list.end(), of_cell.begin(), of_cell.end());
        return list;
      }

    private:
      struct Change
      {
        double       time; // day
        unsigned int type;
        bool
        operator==(const Change &other) const
        {
          return time == other.time && type == other.type;
        }
      };
      using History = std::vector<Change>;

      static History
      history_of(const std::vector<CellEvent> &events)
      {
        History history;
        for (const CellEvent &event : events)
          if (event.kind == CellEvent::transition)
            history.push_back({event.time, event.to});
        return history;
      }

      /** Finds the neighbours. Collective. */
      void
      find_neighbours()
      {
        // Own cells are the first points of the graph, so that their numbers
        // are the same.
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

      const Tissue<dim>       &tissue;
      const StateColumns<dim> &columns;
      const NeighbourSearch    search;
      /** Whether a cell's own change is one beside it: `unlike`. */
      const bool sees_itself;
      bool found = false; // neighbours are looked for if there are changes
      std::map<unsigned int, std::vector<CellEvent>> events_of; // own cells
      NeighbourGraph<dim>                            graph;
      /** Free surface of own cells, µm^(dim-1); empty: nobody asks. */
      std::vector<double> free;
      /** Own cells to which a point of the graph is a neighbour. */
      std::vector<std::vector<unsigned int>> beside_of;
      /** By points of the graph; those without changes have none. */
      std::map<unsigned int, History> histories;
      /** Points of the graph by id. */
      std::map<types::particle_index, unsigned int> point_of;
      std::vector<unsigned int>                     changed; // own cells
      std::vector<unsigned int>                     again;
    };
  } // namespace


  template <int dim>
  void
  CellDevelopment<dim>::expect(const PresentCell<dim>      &before,
                               const CellView<dim, double> &after,
                               const double                 t,
                               const bool                   is_whole,
                               const TypesAround<dim>      *around) const
  {
    // An event in mid-step resets hazards, so that the next step could compare
    // nothing: rates are remembered only of a step without events. What the
    // types beside the cell have changed is in the integrals already, so the
    // next step must not see it as missed: the rate is that among the types at
    // the end.
    if (around == nullptr)
      {
        effects.fates.expect(before, after, t, is_whole);
        return;
      }
    const auto                  at_t0 = before.cell().row();
    std::vector<double>         row(at_t0.begin(), at_t0.end());
    const CellView<dim, double> at_end(make_array_view(row), columns_);
    around->set(at_end, around->size());
    effects.fates.expect(
      PresentCell<dim>(at_end, before.id(), before.position(), before.reader()),
      after,
      t,
      is_whole);
  }


  template <int dim>
  void
  CellDevelopment<dim>::develop(const PresentCell<dim>      &before,
                                const CellView<dim, double> &after,
                                const double                 t0,
                                const double                 t1,
                                const TypesAround<dim>      *around,
                                std::vector<CellEvent>      &events,
                                Errors                      &errors) const
  {
    // The cell is seen twice: `before` is its committed state of t0 and is
    // never written, `after` is a copy of its row that becomes the state of t1.
    // Three passes follow: events and clocks, then what effects keep, then the
    // product (8.7) of doc/theory.md. The step's equilibrium is sought
    // afterwards with the new F_g, so F in `after` is still that of t0.

    // What happens to the cell comes first, as growth depends on it: a cell
    // that dies or enters S within the step grows otherwise from then on.
    errors.missed_growth       = 0.;
    const std::size_t n_events = events.size();
    const bool dead = effects.fates.is_dead_at(before, after, t0, events);
    if (!dead)
      {
        // The integral of a rate gets what the last step missed of it,
        // doc/theory.md (5.9), before thresholds are looked for.
        effects.fates.make_good(before, after);
        if (announces_growth)
          announce_growth(before, after, t0, t1);
        // A clock that no other fate can interrupt never has to be taken back,
        // so it needs no search for the earliest event.
        if (effects.proliferation && effects.fates.list.size() == 1)
          effects.proliferation->run_clock(before, after, {t0, t1});
        else
          effects.fates.live(before, after, t0, t1, events, around);
        expect(
          before, after, 0.5 * (t0 + t1), events.size() == n_events, around);
      }
    for (const Effect<dim> *effect : effects.with_state)
      effect->advance(before, after, t0, t1);
    if (!grows())
      return;

    // The product of all that grows is doc/theory.md (8.7). A dead cell keeps
    // the growth that it had and shrinks by (6.9); one that dies in this step
    // grows until its death. Flows come last: they relax the stress of the
    // elastic part, which is known only when all other factors are.
    Tensor<2, dim> F_g =
      dead ? before.cell().growth() :
             living_growth(before,
                           after,
                           t0,
                           std::min(t1, effects.fates.time_of_death(after)),
                           errors.missed_growth);
    for (const Dies<dim> *const dies : effects.fates.deadly)
      if (dies->time_of_death(after) <= t1)
        F_g *= dies->shrink(after, t1);
    F_g = flow(before, after, F_g, t0, t1, errors);
    after.set(columns_.growth, F_g);
  }


  template <int dim>
  DevelopmentOfStep<dim>
  CellDevelopment<dim>::of_step(const Tissue<dim> &tissue,
                                const double       t0,
                                const double       t1,
                                const PastStep    &past) const
  {
    // The loop is over the cells that this rank owns, in the order of the
    // store, and no cell reads another one. The tissue is left as it is,
    // because the step may fail and be repeated with half the length. The
    // results are vectors in the same order, with the growth of t0 and of t1
    // for the first tangent, doc/theory.md (5.1). Where changes of type depend
    // on the types of the cells beside, some cells then live again, until all
    // have seen what those beside them do: section 12.1.
    DevelopmentOfStep<dim> result;
    result.present = grows();
    result.past    = past;
    if (!present())
      return result;
    const std::size_t n = tissue.cells().size();
    if (keeps_rows)
      // let_live() appends them: memory of that size is not written twice.
      result.rows.reserve(n * columns_.n_numbers());
    if (grows())
      {
        result.previous.resize(n);
        result.current.resize(n);
      }
    if (effects.law_follows_state())
      result.missed_growth.resize(n);
    if (material.depends_on_state())
      result.lame.resize(n);
    result.flow_shares.resize(n * effects.flows.size());
    if (!effects.flows.empty())
      result.relaxation.resize(n);
    const CellReader<dim> reader = this->reader(t0, past);
    everywhere(tissue.communicator(), [&]() {
      for (unsigned int p = 0; p < n; ++p)
        let_live(tissue, p, t1, reader, nullptr, result);
    });
    if (effects.neighbours)
      see_neighbours(tissue, t0, t1, result);
    return result;
  }


  template <int dim>
  void
  CellDevelopment<dim>::see_neighbours(const Tissue<dim>      &tissue,
                                       const double            t0,
                                       const double            t1,
                                       DevelopmentOfStep<dim> &result) const
  {
    // Each round lets those cells live again beside which something has come
    // out otherwise than they saw it. In round k all is right that has fewer
    // than k causes in the step, one after the other: so the rounds end, and
    // the result is that of all events in the order of time, whatever the
    // ranks.
    NeighbourHistories<dim> histories(tissue,
                                      state_,
                                      *effects.neighbours,
                                      result.events);
    const CellReader<dim>   reader = this->reader(t0, result.past);
    while (histories.exchange())
      everywhere(tissue.communicator(), [&]() {
        for (const unsigned int p : histories.to_live_again())
          {
            result.events.clear();
            const TypesAround<dim> around = histories.around(p);
            let_live(tissue, p, t1, reader, &around, result);
            histories.set(p, result.events);
          }
      });
    result.events = histories.events();
  }


  template <int dim>
  void
  CellDevelopment<dim>::let_live(const Tissue<dim>      &tissue,
                                 const unsigned int      p,
                                 const double            t1,
                                 const CellReader<dim>  &reader,
                                 const TypesAround<dim> *around,
                                 DevelopmentOfStep<dim> &result) const
  {
    // The next state is written where it is kept; all cells share one row where
    // it is not. Stiffness that depends on the state is that of the cell with
    // its new type and age, so it is read with the time of the end.
    const Cells<dim>      &cells = tissue.cells();
    const auto             cell  = cells[p];
    const PresentCell<dim> before(cell, cells.id(p), cells.position(p), reader);
    const std::size_t      width = columns_.n_numbers();
    const std::size_t      place = keeps_rows ? p * width : 0;
    if (place == result.rows.size())
      result.rows.insert(result.rows.end(),
                         cell.row().begin(),
                         cell.row().end());
    else
      std::copy(cell.row().begin(),
                cell.row().end(),
                result.rows.begin() + place);
    const CellView<dim, double> after(
      ArrayView<double>(result.rows.data() + place, width), columns_);
    Errors errors;
    develop(before, after, reader.time, t1, around, result.events, errors);
    if (grows())
      {
        result.previous[p] = cell.growth();
        result.current[p]  = after.growth();
      }
    if (effects.law_follows_state())
      result.missed_growth[p] = errors.missed_growth;
    std::copy(errors.flow_shares.begin(),
              errors.flow_shares.end(),
              result.flow_shares.begin() + p * effects.flows.size());
    if (!effects.flows.empty())
      result.relaxation[p] = errors.relaxed;
    if (material.depends_on_state())
      {
        const CellReader<dim> after_step = this->reader(t1);
        result.lame[p] =
          PresentCell<dim>(after, cells.id(p), cells.position(p), after_step)
            .lame();
      }
  }


  template class CellDevelopment<2>;
  template class CellDevelopment<3>;
} // namespace Morula
