// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/cell_hazard.h>

namespace Morula
{
  template <int dim>
  CellHazard<dim>::CellHazard(const Expression     &rate,
                              const Column<double> &integral,
                              const Column<double> &expected)
    : rate_(rate)
    , integral(integral)
    , expected(expected)
  {}


  template <int dim>
  Hazard
  CellHazard<dim>::in(const Stretch                     &stretch,
                      const PresentCell<dim>            &cell,
                      const CellView<dim, const double> &row,
                      const double                       threshold) const
  {
    return {cell.value(rate_, 0.5 * (stretch.begin + stretch.end)),
            row.get(integral),
            threshold};
  }


  template <int dim>
  void
  CellHazard<dim>::integrate(const Hazard                &hazard,
                             const Stretch               &stretch,
                             const double                 s,
                             const CellView<dim, double> &row) const
  {
    row.set(integral, hazard.integral_at(stretch.begin, s));
  }


  template <int dim>
  void
  CellHazard<dim>::make_good(const PresentCell<dim>      &before,
                             const CellView<dim, double> &row) const
  {
    const PastStep &past = before.reader().past;
    if (past.exists() && expected.exists())
      row.set(integral,
              with_missed(row.get(integral),
                          before.value(rate_, past.middle()),
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
    if (expected.exists())
      row.set(expected, is_whole ? before.value(rate_, t) : not_expected);
  }


  template class CellHazard<2>;
  template class CellHazard<3>;
} // namespace Morula
