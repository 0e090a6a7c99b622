// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_cell_hazard_h
#define morula_effects_fate_cell_hazard_h

#include <morula/effects/fate/fate.h>
#include <morula/effects/fate/hazard.h>

namespace Morula
{
  /**
   * A rate of cells (1/day) with the column of its integral: doc/theory.md
   * (6.6). A rate that follows the cells' state has one more column, for what
   * the step before has seen of it: (5.9).
   */
  template <int dim>
  class CellHazard
  {
  public:
    /** @param rate     came from StateColumns::use()
     *  @param integral does not exist if the rate is always zero
     *  @param expected does not exist if nothing can be missed */
    CellHazard(const Expression     &rate,
               const Column<double> &integral,
               const Column<double> &expected);

    bool
    exists() const
    {
      return integral.exists();
    }

    const Expression &
    rate() const
    {
      return rate_;
    }

    /** The chance of the event from the beginning of a stretch on.
     *  @param row of that time. @throws InputError for negative rates */
    Hazard
    in(const Stretch                     &stretch,
       const PresentCell<dim>            &cell,
       const CellView<dim, const double> &row,
       const double                       threshold) const;

    /** Keeps the integral of in() at @p s, day. */
    void
    integrate(const Hazard                &hazard,
              const Stretch               &stretch,
              const double                 s,
              const CellView<dim, double> &row) const;

    /** As Fate::make_good(). */
    void
    make_good(const PresentCell<dim>      &before,
              const CellView<dim, double> &row) const;

    /** As Fate::expect(). */
    void
    expect(const PresentCell<dim>      &before,
           const CellView<dim, double> &row,
           const double                 t,
           const bool                   is_whole) const;

  private:
    Expression     rate_;
    Column<double> integral;
    Column<double> expected;
  };
} // namespace Morula

#endif
