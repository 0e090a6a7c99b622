// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_hazard_h
#define morula_effects_fate_hazard_h

#include <morula/base/expression.h>
#include <morula/particles/cell_state.h>

#include <functional>
#include <optional>
#include <string>

namespace Morula
{
  using namespace dealii;

  template <int dim>
  class PresentCell;

  /**
   * The chance of an event, integrated: the event comes when the integral of
   * its rate reaches a threshold that is exponentially distributed with mean 1.
   * doc/theory.md (6.6), (6.7). The rate is constant from t0 on.
   */
  struct Hazard
  {
    double rate;      // 1/day, >= 0
    double integral;  // at t0
    double threshold; // of the integral

    /** When the event comes, if it does in [t0, t1]; day. It comes at t0 if the
     *  integral has reached the threshold. */
    std::optional<double>
    event(const double t0, const double t1) const;

    /** The integral at @p t. */
    double
    integral_at(const double t0, const double t) const
    {
      return integral + rate * (t - t0);
    }
  };

  /** The rate that a step expects at its end where there is nothing to compare,
   *  as after a birth or a change of type. */
  constexpr double not_expected = -1.;

  /**
   * The integral of a rate that follows the state, with what the last step
   * missed of it: doc/theory.md (5.9). Not negative.
   * @param rate     for the last step's middle, in the present state
   * @param expected the same in the state before; or not_expected
   * @param dt       the last step's length, day
   */
  double
  with_missed(const double integral,
              const double rate,
              const double expected,
              const double dt);

  /** A rate of cells with the columns that it needs: doc/theory.md (6.6). */
  template <int dim>
  struct CellHazard
  {
    /** 1/day, from StateColumns::use(). */
    Expression rate;
    /** The integral of the rate. */
    Column<double> integral;
    /** What the step before saw of a rate that follows the cells' state, (5.9);
     *  does not exist for others. */
    Column<double> expected;
    /** The threshold of a cell with its row of the moment. */
    std::function<double(const PresentCell<dim> &,
                         const CellView<dim, const double> &)>
      threshold = {};
    /** What no cell does by a rate that is 0 everywhere, a sentence; empty: no
     *  warning. */
    std::string nobody = {};
    /** Whether the integral of a cell runs; null: always. */
    std::function<bool(const CellView<dim, const double> &)> runs = {};

    /** The chance of the event in [t0, t1], day, from the integral in @p row
     *  on. @throws InputError for negative rates */
    Hazard
    in(const double                       t0,
       const double                       t1,
       const PresentCell<dim>            &cell,
       const CellView<dim, const double> &row) const
    {
      return {cell.value(rate, 0.5 * (t0 + t1)),
              row.get(integral),
              threshold(cell, row)};
    }

    /** Adds what the last step missed of the integral to the row of a living
     *  cell. */
    void
    make_good(const PresentCell<dim>      &before,
              const CellView<dim, double> &row) const;

    /** Keeps what the next step will compare in make_good(). @param t the
     *  middle of the step, day. @param is_whole whether nothing has happened to
     *  the cell in it */
    void
    expect(const PresentCell<dim>      &before,
           const CellView<dim, double> &row,
           const double                 t,
           const bool                   is_whole) const;
  };
} // namespace Morula

#endif
