// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/surface_energy.h>
#include <morula/effects/surface/surface_tension.h>

namespace Morula
{
  bool
  SurfaceTensionParameters::is_on() const
  {
    // The place has a default, everywhere. So the tension itself says whether
    // there is one.
    return !where.empty() && !tension.is_default();
  }


  void
  SurfaceTensionParameters::check(const SceneKeys &scene, Review &) const
  {
    if (scene.catalogue.tensions().any_with_surface() && !tension.is_default())
      tension.refuse("its default, as types of cells have tensions with the "
                     "surface",
                     "Remove this key, or each type's Tension/With surface.");
  }


  std::string
  SurfaceTensionParameters::details() const
  {
    return "; " + tension.text() + " kPa um";
  }


  template <int dim>
  SurfaceTension<dim>::SurfaceTension(const Parameters &parameters)
    : PlacedCondition<dim>(SurfaceCondition::loaded, parameters)
    , tension(parameters.tension.expression(dim))
  {}


  template <int dim>
  std::unique_ptr<Term<dim>>
  SurfaceTension<dim>::term(const LoadedPoints<dim> &points,
                            const double             t) const
  {
    using Load = typename AreaTerm<dim>::Load;
    return std::make_unique<SurfaceEnergy<dim>>(
      points, this->template loads<Load>(points, [&](const auto &point) {
        return Load{tension.value(point.X, t), point.area};
      }));
  }


  template <int dim>
  void
  SurfaceTension<dim>::check_at(const Point<dim> &X, const double t) const
  {
    tension.value(X, t);
  }


  template class SurfaceTension<2>;
  template class SurfaceTension<3>;
} // namespace Morula
