// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_divide_h
#define morula_effects_division_divide_h

#include <morula/effects/development.h>
#include <morula/particles/cell_event.h>
#include <morula/particles/tissue.h>

#include <tuple>
#include <vector>

namespace Morula
{
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

  /** Positions, in the order of Tissue::cells(), of this rank's cells that
   *  divide at or before @p t (day). Only where cells divide. */
  template <int dim>
  std::vector<unsigned int>
  cells_due(const Tissue<dim>          &tissue,
            const CellDevelopment<dim> &development,
            const double                t);

  /**
   * Divides each of these cells into two. daughter_distances() gives the
   * daughters' places. They inherit every column by its rule: F, equation (17)
   * of the paper, F_g and half of V⁰, equation (18), and what their fates say.
   * All divisions see the same configuration. Collective.
   * @param t1 end of the step, day
   * @param next_id first free id, the same on all ranks; advanced
   * @param events  gets what happens to daughters before the end of the step
   * @return the daughters born on this rank
   */
  template <int dim>
  std::vector<Birth<dim>>
  divide(Tissue<dim>                     &tissue,
         const CellDevelopment<dim>      &development,
         const std::vector<unsigned int> &due,
         const double                     t1,
         types::particle_index           &next_id,
         std::vector<CellEvent>          &events);
} // namespace Morula

#endif
