// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_events_h
#define morula_output_events_h

#include <morula/particles/cell_event.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace Morula
{
  /** What events.csv records. */
  struct EventsContents
  {
    /** The names of the types, by their numbers; empty: there are no types. */
    std::vector<std::string> type_names;
    /** Whether deaths have causes. */
    bool with_causes = false;
  };

  /** The columns of events.csv. */
  std::vector<std::string>
  event_columns(const EventsContents &contents);

  /**
   * A step's rows of events.csv, on rank 0: one for each event of a cell on any
   * rank, ordered by time, then by the cell's id, then by kind. Collective.
   * @param events of this rank, in any order
   */
  std::string
  event_rows(const std::vector<CellEvent> &events,
             const EventsContents         &contents,
             const MPI_Comm                comm);
} // namespace Morula

#endif
