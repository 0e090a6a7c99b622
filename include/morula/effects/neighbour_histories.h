// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_neighbour_histories_h
#define morula_effects_neighbour_histories_h

#include <morula/effects/fate/types_around.h>
#include <morula/particles/cell_event.h>
#include <morula/particles/neighbours.h>
#include <morula/particles/tissue.h>

#include <map>
#include <vector>

namespace Morula
{
  /**
   * What the events of a step do to the types of cells, as the cells beside
   * them see it: doc/theory.md, section 12.1. The neighbours are those at the
   * beginning of the step.
   */
  template <int dim>
  class NeighbourHistories
  {
  public:
    /** @param events of this rank's cells, as if nobody saw the others. Refers
     *  to the tissue and its columns, which must outlive it. Collective. */
    NeighbourHistories(const Tissue<dim>            &tissue,
                       const StateColumns<dim>      &columns,
                       const NeighbourSearch        &search,
                       const std::vector<CellEvent> &events);

    /** Tells all ranks what has changed since the last call. @return whether
     *  some cell of some rank has to live again. Collective. */
    bool
    exchange();

    /** The cells of this rank that have to, since the last exchange(). */
    const std::vector<unsigned int> &
    to_live_again() const
    {
      return again;
    }

    /** The types beside cell @p p of this rank. */
    TypesAround<dim>
    around(const unsigned int p) const;

    /** The events of cell @p p of this rank have come out so. */
    void
    set(const unsigned int p, const std::vector<CellEvent> &events);

    /** All events of this rank's cells, in the order of the cells. */
    std::vector<CellEvent>
    events() const;

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
    history_of(const std::vector<CellEvent> &events);

    /** Finds the neighbours. Collective. */
    void
    find_neighbours();

    const Tissue<dim>       &tissue;
    const StateColumns<dim> &columns;
    const NeighbourSearch    search;
    /** Whether a cell's own change is one beside it: `unlike`. */
    const bool sees_itself;
    bool       found = false; // neighbours are looked for if there are changes
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
} // namespace Morula

#endif
