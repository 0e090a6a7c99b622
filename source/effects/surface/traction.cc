// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/dead_load.h>
#include <morula/effects/surface/traction.h>

namespace Morula
{
  std::string
  TractionParameters::details() const
  {
    return "; " + traction.text() + " kPa";
  }


  template <int dim>
  Traction<dim>::Traction(const Parameters &parameters)
    : PlacedCondition<dim>(SurfaceCondition::loaded, parameters)
    , traction(parameters.traction.expression(dim))
  {}


  template <int dim>
  std::unique_ptr<Term<dim>>
  Traction<dim>::term(const LoadedPoints<dim> &points, const double t) const
  {
    return std::make_unique<DeadLoad<dim>>(
      points,
      // The area is the initial one: a dead load.
      this->template loads<Tensor<1, dim>>(points, [&](const auto &point) {
        return point.initial_area * traction.vector(point.X, t);
      }));
  }


  template <int dim>
  void
  Traction<dim>::check_at(const Point<dim> &X, const double t) const
  {
    // To evaluate it is the check: an expression without a value throws.
    traction.vector(X, t);
  }


  template class Traction<2>;
  template class Traction<3>;
} // namespace Morula
