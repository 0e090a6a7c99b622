// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/slip.h>

#include <cmath>

namespace Morula
{
  template <int dim>
  Slip<dim>::Slip(const Parameters &parameters)
    : PlacedCondition<dim>(SurfaceCondition::slip, parameters)
  {
    if (!parameters.normal->empty())
      normal = unit_vector<dim>(parameters.normal.path(), parameters.normal);
  }


  template <int dim>
  bool
  Slip<dim>::acts_on(const Point<dim> &X, const Tensor<1, dim> &N) const
  {
    // 0.9 is the cosine of 26 degrees: points of one flat side have the same
    // normal, those of its neighbours another.
    return PlacedCondition<dim>::acts_on(X, N) &&
           (!normal || std::abs(N * *normal) > 0.9);
  }


  template class Slip<2>;
  template class Slip<3>;
} // namespace Morula
