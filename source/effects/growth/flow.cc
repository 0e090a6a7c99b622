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


  template class Flow<2>;
  template class Flow<3>;
} // namespace Morula
