// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/fate.h>

#include <limits>

// A fate that says nothing else does nothing: it has no events, no deaths and
// no rates, and nothing is inherited. A new fate overrides only what concerns
// it.

namespace Morula
{
  template <int dim>
  void
  Fate<dim>::make_good(const PresentCell<dim> &,
                       const CellView<dim, double> &) const
  {}


  template <int dim>
  void
  Fate<dim>::pass(const PresentCell<dim> &,
                  const CellView<dim, double> &,
                  const Stretch &,
                  const double) const
  {}


  template <int dim>
  void
  Fate<dim>::expect(const PresentCell<dim> &,
                    const CellView<dim, double> &,
                    const double,
                    const bool) const
  {}


  template <int dim>
  void
  Fate<dim>::end_of_life(const PresentCell<dim> &,
                         const CellView<dim, double> &,
                         const double) const
  {}


  template <int dim>
  void
  Fate<dim>::inherit(const CellView<dim, double> &,
                     const StateColumns<dim> &,
                     const unsigned int,
                     const double) const
  {}


  template <int dim>
  std::vector<const Expression *>
  Fate<dim>::rates(const unsigned int) const
  {
    return {};
  }


  template <int dim>
  bool
  Fate<dim>::divides() const
  {
    return false;
  }


  template <int dim>
  bool
  Fate<dim>::follows_growth() const
  {
    return false;
  }


  template <int dim>
  void
  Fate<dim>::grow(const PresentCell<dim> &,
                  const CellView<dim, double> &,
                  const double,
                  const Stretch &) const
  {}


  template <int dim>
  double
  Fate<dim>::time_of_division(const CellView<dim, const double> &,
                              const double) const
  {
    return std::numeric_limits<double>::infinity();
  }


  template <int dim>
  Tensor<1, dim>
  Fate<dim>::placement_axis(const CellView<dim, const double> &,
                            const unsigned int) const
  {
    // Only fates that divide cells are asked.
    Assert(false, ExcNotImplemented());
    return {};
  }


  template <int dim>
  bool
  Fate<dim>::stays_inside() const
  {
    return false;
  }


  template <int dim>
  bool
  Fate<dim>::is_deadly() const
  {
    return false;
  }


  template <int dim>
  bool
  Fate<dim>::may_strike() const
  {
    return false;
  }


  template <int dim>
  bool
  Fate<dim>::strikes(const PresentCell<dim> &, const double) const
  {
    return false;
  }


  template <int dim>
  void
  Fate<dim>::strike(const PresentCell<dim> &,
                    const CellView<dim, double> &,
                    const double,
                    std::vector<CellEvent> &) const
  {}


  template <int dim>
  double
  Fate<dim>::time_of_death(const CellView<dim, const double> &) const
  {
    // No death is an infinite time, so that the earliest of all fates is a
    // minimum.
    return std::numeric_limits<double>::infinity();
  }


  template <int dim>
  double
  Fate<dim>::shrink(const CellView<dim, double> &, const double) const
  {
    // This is a factor of lengths: 1 leaves F_g as it is.
    return 1.;
  }


  template <int dim>
  double
  Fate<dim>::removal_time(const CellView<dim, const double> &) const
  {
    return std::numeric_limits<double>::infinity();
  }


  template <int dim>
  bool
  Fate<dim>::is_due_for_removal(const CellView<dim, const double> &cell,
                                const double                       t) const
  {
    return removal_time(cell) <= t;
  }


  template <int dim>
  bool
  Fate<dim>::shrinks(const CellView<dim, const double> &) const
  {
    return false;
  }


  template class Fate<2>;
  template class Fate<3>;
} // namespace Morula
