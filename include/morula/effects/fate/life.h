// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_life_h
#define morula_effects_fate_life_h

#include <morula/effects/fate/fate.h>
#include <morula/effects/fate/types_around.h>

#include <memory>
#include <vector>

namespace Morula
{
  /** The fates of a scene's cells, in the order in which they are asked. */
  template <int dim>
  using Fates = std::vector<std::unique_ptr<const Fate<dim>>>;

  /**
   * Lets a cell live through (t0, t1], day, event by event: doc/theory.md,
   * sections 6.8 and 6.9. Its row is then that of t1, or of its death. What
   * would come after a division is left out: it happens to the daughters.
   * @param before the cell at the beginning of the step
   * @param row    its row at @p t0, to be written
   * @param events gets what happens
   * @param around the types of the cells beside it, if they change in the step;
   *        or null
   * @throws InputError for rates without a value, or too many events
   */
  template <int dim>
  void
  live(const Fates<dim>            &fates,
       const PresentCell<dim>      &before,
       const CellView<dim, double> &row,
       const double                 t0,
       const double                 t1,
       std::vector<CellEvent>      &events,
       const TypesAround<dim>      *around = nullptr);

  /** Ends the cell's life at @p t (day) if it is dead, or a fate strikes it
   *  then. @return whether it is dead. @throws InputError */
  template <int dim>
  bool
  is_dead_at(const Fates<dim>            &fates,
             const PresentCell<dim>      &before,
             const CellView<dim, double> &row,
             const double                 t,
             std::vector<CellEvent>      &events);

  /** When the cell's life ended, day; infinity: it lives. */
  template <int dim>
  double
  time_of_death(const Fates<dim>                  &fates,
                const CellView<dim, const double> &cell);

  /** Whether the cell is dead, but still there. */
  template <int dim>
  bool
  is_dead(const Fates<dim> &fates, const CellView<dim, const double> &cell);
} // namespace Morula

#endif
