// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/surface/surface_energy.h>
#include <morula/effects/surface/surface_tension.h>

#include <sstream>
#include <utility>

namespace Morula
{
  namespace
  {
    const std::string remedy =
      "A surface with a negative tension would crumple.";
  } // namespace


  SurfaceTensionParameters::SurfaceTensionParameters()
    : ConditionKeys("Boundary conditions/Surface tension where",
                    "Expression of X, Y, Z: the surface has the tension where "
                    "it is > 0; 1: everywhere.",
                    "1")
    , tension("Boundary conditions/Surface tension",
              "0",
              "Tension of the surface, a function of X, Y, Z, t; not negative. "
              "0: none. 1 kPa um = 1 mN/m. Units: kPa um.",
              Evaluated::place)
  {
    tension.not_negative("kPa um", remedy);
  }


  bool
  SurfaceTensionParameters::is_on() const
  {
    return !where.empty() && !tension.is_default();
  }


  KeyList
  SurfaceTensionParameters::list()
  {
    return {&where, &tension};
  }


  std::string
  SurfaceTensionParameters::details() const
  {
    return "; " + tension.text() + " kPa um";
  }


  template <int dim>
  SurfaceTension<dim>::SurfaceTension(const Parameters &parameters)
    : where(parameters.where.expression(dim))
    , tension(parameters.tension.expression(dim))
  {}


  template <int dim>
  SurfaceCondition
  SurfaceTension<dim>::kind() const
  {
    return SurfaceCondition::loaded;
  }


  template <int dim>
  bool
  SurfaceTension<dim>::acts_on(const Point<dim> &X,
                               const Tensor<1, dim> &) const
  {
    return holds(where, X);
  }


  template <int dim>
  double
  SurfaceTension<dim>::value(const Point<dim> &X, const double t) const
  {
    const double gamma = tension.value(X, t);
    if (gamma >= 0.)
      return gamma;
    std::ostringstream place;
    place << "It is " << gamma << " at (" << X << ") um, t = " << t << " day. "
          << remedy;
    throw InputError(tension.key(),
                     tension.text(),
                     "a value >= 0 kPa um",
                     place.str());
  }


  template <int dim>
  std::unique_ptr<Term<dim>>
  SurfaceTension<dim>::term(const LoadedPoints<dim> &points,
                            const double             t) const
  {
    std::vector<typename SurfaceEnergy<dim>::Load> loads;
    for (const auto &point : points.points)
      loads.push_back(
        {holds(where, point.X_seed) ? value(point.X, t) : 0., point.area});
    return std::make_unique<SurfaceEnergy<dim>>(points, std::move(loads));
  }


  template <int dim>
  void
  SurfaceTension<dim>::check(const Preview<dim> &scene) const
  {
    for (const Point<dim> &X : scene.boundary_points)
      if (holds(where, X))
        for (const double t : {0., scene.end_time})
          value(X, t);
  }


  template class SurfaceTension<2>;
  template class SurfaceTension<3>;
} // namespace Morula
