// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/extrusion.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/state/present_cell.h>

namespace Morula
{
  template <int dim>
  Extrusion<dim>::Extrusion(const Parameters         &parameters,
                            const EffectSetting<dim> &setting)
    : EndAtRate<dim>(parameters.rate,
                     setting,
                     {"extrusion",
                      "when the cell leaves; -1: not yet",
                      "no cell leaves by it.",
                      false})
  {}


  template <int dim>
  LifeAfter
  Extrusion<dim>::happen(const PresentCell<dim>      &cell,
                         const CellView<dim, double> &row,
                         const Stretch &,
                         const double            s,
                         std::vector<CellEvent> &events) const
  {
    this->end(row, s);
    events.push_back(
      {s, cell.id(), CellEvent::death, cell.type(), cell.type(), "extruded"});
    return LifeAfter::ends;
  }


  template <int dim>
  double
  Extrusion<dim>::removal_time(const CellView<dim, const double> &cell) const
  {
    // The event lies within the step, so the cell goes at its end.
    return this->time_of_death(cell);
  }


  template <int dim>
  bool
  Extrusion<dim>::shrinks(const CellView<dim, const double> &cell) const
  {
    // Nothing shrinks, but the space is handed on as that of a shrunken cell.
    return this->has_ended(cell);
  }


  template <int dim>
  void
  Extrusion<dim>::check_cell(const PresentCell<dim> &founder,
                             const double) const
  {
    founder.value(*this->rates(0)[0], 0.);
  }


  template class Extrusion<2>;
  template class Extrusion<3>;
} // namespace Morula
