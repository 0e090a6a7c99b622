// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_division_divide_h
#define morula_effects_division_divide_h

#include <morula/effects/development.h>
#include <morula/particles/cell_event.h>
#include <morula/particles/tissue.h>

#include <vector>

namespace Morula
{
  /** Positions, in the order of Tissue::cells(), of this rank's cells that
   *  divide at or before @p t (day). Only where cells divide. */
  template <int dim>
  std::vector<unsigned int>
  cells_due(const Tissue<dim>          &tissue,
            const CellDevelopment<dim> &development,
            const double                t);

  /** The result of divisions. */
  template <int dim>
  struct Divisions
  {
    /** The daughters born on this rank. */
    std::vector<Birth<dim>> births;
    /** What happened to them before the end of the step. */
    std::vector<CellEvent> events;
  };

  /**
   * Divides each of these cells into two. daughter_distances() gives the
   * daughters' places. They inherit every column by its rule: F, equation (17)
   * of the paper, F_g and half of V⁰, equation (18), and what their fates say.
   * All divisions see the same configuration. Collective.
   * @param t1 end of the step, day
   * @param next_id first free id, the same on all ranks; advanced
   */
  template <int dim>
  Divisions<dim>
  divide(Tissue<dim>                     &tissue,
         const CellDevelopment<dim>      &development,
         const std::vector<unsigned int> &due,
         const double                     t1,
         types::particle_index           &next_id);
} // namespace Morula

#endif
