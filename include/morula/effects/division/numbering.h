// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_numbering_h
#define morula_effects_division_numbering_h

#include <deal.II/particles/property_pool.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
  using namespace dealii;

  /** When which cell divides. */
  struct DivisionEvent
  {
    double                time;   // day, exact
    types::particle_index mother; // id
  };

  /**
   * Ids of the daughters of this rank's divisions: all ranks' divisions are
   * ordered by (time, mother's id) and get two ids each from @p next_id on, the
   * -n_s daughter first. Returns the first daughter's id for each event; the
   * second's is one more. @p next_id is advanced by twice the global number of
   * divisions. Collective.
   */
  std::vector<types::particle_index>
  number_daughters(const std::vector<DivisionEvent> &events,
                   types::particle_index            &next_id,
                   const MPI_Comm                    comm);
} // namespace Morula

#endif
