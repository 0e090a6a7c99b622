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
  Tensor<1, dim>
  Fate<dim>::placement_axis(const CellView<dim, const double> &,
                            const unsigned int) const
  {
    // Only fates that divide cells are asked.
    Assert(false, ExcNotImplemented());
    return {};
  }


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


  template class Fate<2>;
  template class Fate<3>;
} // namespace Morula
