// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/following_pressure.h>
#include <morula/effects/surface/pressure.h>

namespace Morula
{
  std::string
  PressureParameters::details() const
  {
    return "; " + pressure.text() + " kPa";
  }


  template <int dim>
  Pressure<dim>::Pressure(const Parameters &parameters)
    : PlacedCondition<dim>(SurfaceCondition::loaded, parameters)
    , pressure(parameters.pressure.expression(dim))
  {}


  template <int dim>
  std::unique_ptr<Term<dim>>
  Pressure<dim>::term(const LoadedPoints<dim> &points, const double t) const
  {
    using Load = typename AreaTerm<dim>::Load;
    return std::make_unique<FollowingPressure<dim>>(
      // The value is that at the end of the step, at the point's own X; whether
      // it acts, its seed decides.
      points,
      this->template loads<Load>(points, [&](const auto &point) {
        return Load{pressure.value(point.X, t), point.area};
      }));
  }


  template <int dim>
  void
  Pressure<dim>::check_at(const Point<dim> &X, const double t) const
  {
    // To evaluate it is the check: an expression without a value throws.
    pressure.value(X, t);
  }


  template class Pressure<2>;
  template class Pressure<3>;
} // namespace Morula
