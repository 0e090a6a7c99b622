// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/type_tension.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/surface_energy.h>
#include <morula/effects/surface/type_surface_tension.h>
#include <morula/particles/nearest.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  void
  TypeSurfaceTensionParameters::declare_sections(
    const std::string &, const std::vector<std::string> &names)
  {
    types = names;
    // A type may be called "surface"; the tension with it has this path then.
    if (std::find(names.begin(), names.end(), "surface") == names.end())
      for (const std::string &name : names)
        tensions.emplace_back(
          "Cell types/" + name + "/Tension/With surface",
          0.,
          "Tension of the free surface where cells of this type are nearest. "
          "Units: kPa um.");
  }


  void
  TypeSurfaceTensionParameters::see(const SceneKeys &scene,
                                    const std::vector<ExpressionKey *> &)
  {
    pulls = scene.keys<TypeTensionParameters>().force;
  }


  bool
  TypeSurfaceTensionParameters::is_on() const
  {
    return pulls && std::any_of(tensions.begin(),
                                tensions.end(),
                                [](const auto &key) { return key != 0.; });
  }


  std::string
  TypeSurfaceTensionParameters::details() const
  {
    std::string text;
    for (unsigned int a = 0; a < tensions.size(); ++a)
      text += "; " + types[a] + " " + tensions[a].text() + " kPa um";
    return text;
  }


  KeyList
  TypeSurfaceTensionParameters::list()
  {
    KeyList list;
    for (Key<double> &key : tensions)
      list.push_back(&key);
    return list;
  }


  template <int dim>
  TypeSurfaceTension<dim>::TypeSurfaceTension(const Parameters &parameters,
                                              const EffectSetting<dim> &setting)
    : type(setting.columns.template find<unsigned int>("type"))
  {
    for (const Key<double> &key : parameters.tensions)
      {
        if (key < 0.)
          key.refuse("a value >= 0 kPa um",
                     "A surface with a negative tension would crumple: set "
                     "Tension/Force = false, so that only Rearrangement knows "
                     "it.");
        tensions.push_back(key);
      }
  }


  template <int dim>
  std::unique_ptr<Term<dim>>
  TypeSurfaceTension<dim>::term(const LoadedPoints<dim> &points,
                                const double) const
  {
    // Before the run there are no cells to ask, and a tension adds up to no
    // force anyway.
    std::vector<double> of_points(points.points.size(), 0.);
    if (points.tissue != nullptr)
      {
        const Cells<dim>       &cells = points.tissue->cells();
        std::vector<Point<dim>> places;
        for (const auto &point : points.points)
          places.push_back(point.x);
        of_points = nearest_values(
          places,
          cells,
          [&](const unsigned int p) { return tensions[cells.get(type, p)]; },
          Ties::mean,
          points.tissue->grid(),
          points.sides);
      }
    std::vector<typename AreaTerm<dim>::Load> loads;
    for (std::size_t k = 0; k < of_points.size(); ++k)
      loads.push_back({of_points[k], points.points[k].area});
    return std::make_unique<SurfaceEnergy<dim>>(points, std::move(loads));
  }


  template class TypeSurfaceTension<2>;
  template class TypeSurfaceTension<3>;
} // namespace Morula
