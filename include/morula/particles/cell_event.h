// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_cell_event_h
#define morula_particles_cell_event_h

#include <deal.II/base/point.h>
#include <deal.II/particles/property_pool.h>

#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** A kind of events, as a constant of the program. */
  struct EventKind
  {
    /** In events.csv. */
    const char *name;
    /** Of events that happen to a cell at the same time, which comes first. */
    unsigned int order;

    bool
    operator==(const EventKind &other) const
    {
      return std::strcmp(name, other.name) == 0;
    }
  };

  /** Something that happens to a cell between its birth and its end: a row of
   *  events.csv. */
  struct CellEvent
  {
    static constexpr EventKind transition{"transition", 0}; // to another type
    static constexpr EventKind death{"death", 1};
    static constexpr EventKind removal{"removal", 2}; // of a dead cell

    double                time; // day, exact
    types::particle_index id;   // of the cell
    EventKind             kind;
    unsigned int          from; // number of the cell's type before
    unsigned int          to;   // and after; differs in transitions only
    const char           *cause   = "";    // of a death
    bool                  at_once = false; // a death by a condition that held
  };


  /** A cell's row in lineage.csv. */
  template <int dim>
  struct Birth
  {
    types::particle_index id;
    int                   parent;     // -1 for founders
    unsigned int          generation; // of founders 0, or as their file says
    double                time;       // day, exact
    Point<dim>            position;   // at birth, µm
    unsigned int          type = 0;   // number of the type
    /** The columns that are variables, with their names. */
    std::vector<std::pair<std::string, double>> numbers = {};
  };
} // namespace Morula

#endif
