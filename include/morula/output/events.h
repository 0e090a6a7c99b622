// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_events_h
#define morula_output_events_h

#include <morula/particles/type_change.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace Morula
{
  /** The columns of events.csv. */
  std::vector<std::string>
  event_columns();

  /**
   * Rows of events.csv: one for each change of a cell's type on all ranks in a
   * step, ordered by time, then by the cell's id. Collective; on other ranks
   * than 0 it is empty.
   * @param changes of this rank, in any order
   * @param type_names by the types' numbers
   */
  std::string
  event_rows(const std::vector<TypeChange>  &changes,
             const std::vector<std::string> &type_names,
             const MPI_Comm                  comm);
} // namespace Morula

#endif
