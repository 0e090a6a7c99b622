// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_numbering_h
#define morula_effects_division_numbering_h

#include <deal.II/particles/property_pool.h>

#include <mpi.h>

#include <tuple>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** The division of a cell; ordered by time, then by the mother's id. */
  struct DivisionEvent
  {
    double                time;   // day, exact
    types::particle_index mother; // id

    friend bool
    operator<(const DivisionEvent &a, const DivisionEvent &b)
    {
      return std::tie(a.time, a.mother) < std::tie(b.time, b.mother);
    }

    /** For messages: deal.II demands it of every type, and copies the bytes. */
    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive & time & mother;
    }
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
