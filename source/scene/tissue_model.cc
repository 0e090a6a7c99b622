// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/carriers.h>
#include <morula/scene/tissue_model.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  namespace
  {
    /** What has moments, with names. */
    template <int dim>
    std::vector<std::pair<std::string, const Moments<dim> *>>
    moments_of(const NamedEffects<StepEffect<dim>> &effects,
               const BoundaryConditions<dim>       &conditions)
    {
      std::vector<std::pair<std::string, const Moments<dim> *>> list;
      for (const auto &[name, effect] : effects)
        list.emplace_back(name, effect.get());
      for (const auto &[name, condition] : conditions.list())
        if (const auto *moments =
              dynamic_cast<const Moments<dim> *>(condition.get()))
          list.emplace_back(name, moments);
      return list;
    }

    /** The columns of amounts per volume of all equations. */
    template <int dim>
    std::vector<Column<double>>
    densities_of(const NamedEffects<Equation<dim>> &equations)
    {
      std::vector<Column<double>> list;
      for (const auto &[name, equation] : equations)
        for (const Column<double> &column : equation->densities())
          list.push_back(column);
      return list;
    }
  } // namespace


  template <int dim>
  TissueModel<dim>::TissueModel(const Scene &scene)
    : TissueModel(scene, effects_of<dim>(scene))
  {}


  template <int dim>
  TissueModel<dim>::TissueModel(const Scene &scene, SceneEffects<dim> &&effects)
    : scene(scene)
    , tables(effects.tables())
    , all_effects(effects.all())
    , types(effects.development.types)
    , sees_neighbours(effects.development.neighbours.has_value())
    , material(scene.material)
    , boundary_conditions(std::move(effects.conditions), scene.nitsche)
    , development(std::move(effects.development),
                  effects.columns,
                  effects.state,
                  material,
                  scene.random_seed)
    , equations(std::move(effects.equations))
    , traits(std::move(effects.traits))
    , step_effects(std::move(effects.step_effects))
    , forces(std::move(effects.forces))
    , interaction(std::move(effects.interaction))
    , densities(densities_of<dim>(equations))
    , moments(moments_of<dim>(step_effects, boundary_conditions))
  {}


  template <int dim>
  BoundaryColumns<dim>
  TissueModel<dim>::boundary_columns() const
  {
    // A point stores only what the scene needs: the edges of its patch where
    // patches split, the area that it wants where they merge, the force on it
    // where conditions act.
    BoundaryColumns<dim> columns(scene.tissue.refine_surface,
                                 scene.tissue.coarsen_surface,
                                 !boundary_conditions.list().empty() ||
                                   interaction);
    if (interaction)
      columns.need_bodies(interaction->effect->fuses(),
                          interaction->effect->acts_within_bodies());
    // Nitsche's term (4.2) needs F_g of a carrier. The bounded form needs none,
    // as its traction is that of all cells around a point.
    if (boundary_conditions.has_dirichlet() && development.grows() &&
        boundary_conditions.nitsche().form() != NitscheForm::bounded)
      add_carriers(columns);
    return columns;
  }


  template <int dim>
  double
  TissueModel<dim>::typical_stiffness(const Tissue<dim>            &tissue,
                                      const DevelopmentOfStep<dim> &growth,
                                      const MPI_Comm                comm) const
  {
    // Moduli that depend on the state of cells are those of the step. All
    // others travel with the cell, by the place of its founder. The largest one
    // of all ranks is taken, as it scales penalties.
    double largest = 0.;
    if (material.depends_on_state())
      for (const Lame &lame : growth.lame)
        largest = std::max(largest, youngs_modulus(lame));
    else
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        largest =
          std::max(largest,
                   material.youngs_modulus(tissue.cells().founder_position(p)));
    return Utilities::MPI::max(largest, comm);
  }


  template struct TissueModel<2>;
  template struct TissueModel<3>;
} // namespace Morula
