// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/forces/type_tension.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/surface/loads.h>
#include <morula/particles/nearest.h>

namespace Morula
{
  void
  TypeSurfaceTensionParameters::see(const SceneKeys &scene,
                                    const std::vector<ExpressionKey *> &)
  {
    pulls = scene.keys<TypeTensionParameters>().force;
  }


  namespace
  {
    /** Tension of the free surface by the type of the cell there, with the
     * energy of doc/theory.md (4.8a): a boundary point has that of the nearest
     * cell. */
    template <int dim>
    class TypeSurfaceTension : public BoundaryCondition<dim>
    {
    public:
      using Parameters = TypeSurfaceTensionParameters;

      /** @throws InputError for a negative tension */
      TypeSurfaceTension(const Parameters         &parameters,
                         const EffectSetting<dim> &setting)
        : type(setting.columns.template find<unsigned int>("type"))
      {
        for (const Key<double> &key : parameters.tensions)
          {
            if (key < 0.)
              key.refuse(
                "a value >= 0 kPa um",
                "A surface with a negative tension would crumple: set "
                "Tension/Force = false, so that only Rearrangement uses it.");
            tensions.push_back(key);
          }
      }

      std::unique_ptr<Term<dim>>
      term(const LoadedPoints<dim> &points, const double) const override
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
              [&](const unsigned int p) {
                return tensions[cells.get(type, p)];
              },
              Ties::mean,
              points.tissue->grid(),
              points.sides);
          }
        std::vector<AreaLoad<dim>> loads;
        for (std::size_t k = 0; k < of_points.size(); ++k)
          loads.push_back({of_points[k], points.points[k].area});
        return surface_energy<dim>(points, std::move(loads));
      }

    private:
      std::vector<double>  tensions; // by type
      Column<unsigned int> type;
    };
  } // namespace


  void
  add_type_surface_tension(Catalogue &catalogue)
  {
    catalogue.add_own<TypeSurfaceTension>(
      "type surface tension",
      {"Cell types/Names=a, b",
       "Cell types/b/Where=X*Y > 0",
       "Cell types/b/Tension/With surface=0.1"});
  }
} // namespace Morula
