// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/growth/flow.h>

// A flow that says nothing else keeps no motion and forecasts nothing, so it
// has no error of a forecast either.
namespace Morula
{
  template <int dim>
  void
  Flow<dim>::remember_motion(const CellView<dim, double> &,
                             const Tensor<2, dim> &) const
  {}


  template <int dim>
  bool
  Flow<dim>::has_forecast() const
  {
    return false;
  }


  template <int dim>
  double
  Flow<dim>::error_of_forecast(const CellView<dim, const double> &,
                               const Tensor<2, dim> &,
                               const PastStep &,
                               const double) const
  {
    return 0.;
  }


  template class Flow<2>;
  template class Flow<3>;
} // namespace Morula
