// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/following_pressure.h>
#include <morula/effects/surface/pressure.h>

#include <utility>

namespace Morula
{
  PressureParameters::PressureParameters()
    : ConditionKeys("Boundary conditions/Pressure where",
                    "Expression of X, Y, Z: pressure acts where it is > 0; "
                    "empty: nowhere.")
    , pressure("Boundary conditions/Pressure",
               "0",
               "Pressure that follows the surface, a function of "
               "X, Y, Z, t; positive pushes inward. Units: kPa.",
               Evaluated::place)
  {}


  KeyList
  PressureParameters::list()
  {
    return {&where, &pressure};
  }


  std::string
  PressureParameters::details() const
  {
    return "; " + pressure.text() + " kPa";
  }


  template <int dim>
  Pressure<dim>::Pressure(const Parameters &parameters)
    : where(parameters.where.expression(dim))
    , pressure(parameters.pressure.expression(dim))
  {}


  template <int dim>
  SurfaceCondition
  Pressure<dim>::kind() const
  {
    return SurfaceCondition::loaded;
  }


  template <int dim>
  bool
  Pressure<dim>::acts_on(const Point<dim> &X, const Tensor<1, dim> &) const
  {
    return holds(where, X);
  }


  template <int dim>
  std::unique_ptr<Term<dim>>
  Pressure<dim>::term(const LoadedPoints<dim> &points, const double t) const
  {
    std::vector<typename FollowingPressure<dim>::Load> loads;
    for (const auto &point : points.points)
      loads.push_back(
        {holds(where, point.X_seed) ? pressure.value(point.X, t) : 0.,
         point.area});
    return std::make_unique<FollowingPressure<dim>>(points, std::move(loads));
  }


  template <int dim>
  void
  Pressure<dim>::check(const Preview<dim> &scene) const
  {
    for (const Point<dim> &X : scene.boundary_points)
      if (holds(where, X))
        for (const double t : {0., scene.end_time})
          pressure.value(X, t);
  }


  template class Pressure<2>;
  template class Pressure<3>;
} // namespace Morula
