// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/dead_load.h>
#include <morula/effects/surface/traction.h>

#include <utility>

namespace Morula
{
  TractionParameters::TractionParameters()
    : ConditionKeys("Boundary conditions/Traction where",
                    "Expression of X, Y, Z: traction acts where it is > 0; "
                    "empty: nowhere.")
    , traction("Boundary conditions/Traction",
               "0; 0; 0",
               "Traction per initial area (dead load): functions of "
               "X, Y, Z, t separated by ';'. Units: kPa.",
               Evaluated::place,
               3)
  {}


  KeyList
  TractionParameters::list()
  {
    return {&where, &traction};
  }


  std::string
  TractionParameters::details() const
  {
    return "; " + traction.text() + " kPa";
  }


  template <int dim>
  Traction<dim>::Traction(const Parameters &parameters)
    : where(parameters.where.expression(dim))
    , traction(parameters.traction.expression(dim))
  {}


  template <int dim>
  SurfaceCondition
  Traction<dim>::kind() const
  {
    return SurfaceCondition::loaded;
  }


  template <int dim>
  bool
  Traction<dim>::acts_on(const Point<dim> &X, const Tensor<1, dim> &) const
  {
    return holds(where, X);
  }


  template <int dim>
  std::unique_ptr<Term<dim>>
  Traction<dim>::term(const LoadedPoints<dim> &points, const double t) const
  {
    std::vector<Tensor<1, dim>> forces;
    for (const auto &point : points.points)
      forces.push_back(holds(where, point.X_seed) ?
                         point.initial_area * traction.vector(point.X, t) :
                         Tensor<1, dim>());
    return std::make_unique<DeadLoad<dim>>(points, std::move(forces));
  }


  template <int dim>
  void
  Traction<dim>::check(const Preview<dim> &scene) const
  {
    for (const Point<dim> &X : scene.boundary_points)
      if (holds(where, X))
        for (const double t : {0., scene.end_time})
          traction.vector(X, t);
  }


  template class Traction<2>;
  template class Traction<3>;
} // namespace Morula
