// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/fate.h>
#include <morula/effects/state/present_cell.h>

#include <algorithm>

namespace Morula
{
  std::optional<double>
  Hazard::event(const double t0, const double t1) const
  {
    // The rate is constant in the stretch, so the integral reaches the
    // threshold at the time of doc/theory.md (6.7). A threshold that was passed
    // by what the last step missed is passed at once. The negated comparison
    // leaves out rates that are NaN.
    const double left = threshold - integral;
    if (left <= 0.)
      return t0;
    if (!(rate > 0. && left <= rate * (t1 - t0)))
      return {};
    return t0 + left / rate;
  }


  double
  with_missed(const double integral,
              const double rate,
              const double expected,
              const double dt)
  {
    // This is doc/theory.md (5.9). An expected rate below zero means that there
    // is nothing to compare. The integral of a rate is never negative.
    return expected >= 0. ?
             std::max(0., integral + 0.5 * dt * (rate - expected)) :
             integral;
  }


  template <int dim>
  void
  CellHazard<dim>::make_good(const PresentCell<dim>      &before,
                             const CellView<dim, double> &row) const
  {
    // Where the last step expected nothing the rate may have no value.
    const PastStep &past = before.reader().past;
    if (past.exists() && expected.exists() && row.get(expected) >= 0.)
      row.set(integral,
              with_missed(row.get(integral),
                          before.value(rate, past.middle()),
                          row.get(expected),
                          past.length()));
  }


  template <int dim>
  void
  CellHazard<dim>::expect(const PresentCell<dim>      &before,
                          const CellView<dim, double> &row,
                          const double                 t,
                          const bool                   is_whole) const
  {
    // An integral that began or ended in the step is one of another time.
    if (expected.exists())
      row.set(expected,
              is_whole && (!runs || (runs(before.cell()) && runs(row))) ?
                before.value(rate, t) :
                not_expected);
  }


  template struct CellHazard<2>;
  template struct CellHazard<3>;
} // namespace Morula
