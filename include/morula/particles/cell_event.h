// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_cell_event_h
#define morula_particles_cell_event_h

#include <deal.II/particles/property_pool.h>

namespace Morula
{
  using namespace dealii;

  /** Why a cell died. */
  enum class DeathCause
  {
    none, // it did not die
    rate, // Death/Rate
    when  // Death/When
  };

  /** Something that happens to a cell between its birth and its end: a row of
   *  events.csv. */
  struct CellEvent
  {
    /** The kinds stand in the order in which they can happen to a cell at the
     *  same time. */
    enum class Kind
    {
      transition, // to another type
      death,
      removal // of a dead cell
    };

    double                time; // day, exact
    types::particle_index id;   // of the cell
    Kind                  kind;
    unsigned int          from; // number of the cell's type before
    unsigned int          to;   // and after; differs in transitions only
    DeathCause            cause = DeathCause::none;
  };
} // namespace Morula

#endif
