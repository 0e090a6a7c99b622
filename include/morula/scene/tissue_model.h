// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_tissue_model_h
#define morula_scene_tissue_model_h

#include <morula/effects/development.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/mechanics/material.h>
#include <morula/particles/tissue.h>
#include <morula/scene/scene.h>

#include <mpi.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /** Which laws keep places and volumes of cells together: doc/theory.md,
   *  section 6.11. */
  struct Redistribution
  {
    /** Cells that come too near to each other move apart. */
    bool places = false;
    /** Volumes follow the space that cells have. */
    bool volumes = false;
    /** All tissue flows, not only that which relaxes. */
    bool all_flows = false;
  };

  /** What Tissue/Redistribution means in a scene. */
  Redistribution
  redistribution_of(const Scene &scene);

  /** An effect of a scene, and what it is called. @tparam Kind Force<3>, ... */
  template <typename Kind>
  struct NamedEffect
  {
    std::string                 name;
    std::unique_ptr<const Kind> effect;
  };

  /** Effects of a kind, in the order of the catalogue. */
  template <typename Kind>
  using NamedEffects = std::vector<NamedEffect<Kind>>;

  /** All effects of a scene. */
  template <int dim>
  struct SceneEffects
  {
    /** All of them but the conditions and equations. */
    std::vector<const Effect<dim> *>
    all() const;

    /** What they add to the tables of a run. Refers to them. */
    Tables<dim>
    tables(const Redistribution &redistribution) const
    {
      Tables<dim> tables;
      if (redistribution.places)
        tables.add_number("close_neighbours");
      if (redistribution.volumes)
        tables.add_number("density_error");
      for (const Effect<dim> *const effect : all())
        effect->declare(tables);
      for (const auto &[name, condition] : conditions)
        condition->declare(tables);
      for (const auto &[name, equation] : equations)
        equation->declare(tables);
      return tables;
    }

    /** The columns that the effects need in a cell. */
    CellColumns<dim> columns;
    /** Which variables their expressions use. */
    StateColumns<dim> state;

    DevelopmentEffects<dim>                              development;
    NamedEffects<Equation<dim>>                          equations;
    std::vector<std::unique_ptr<const Trait<dim>>>       traits;
    NamedEffects<StepEffect<dim>>                        step_effects;
    NamedEffects<Force<dim>>                             forces;
    std::optional<NamedEffect<Interaction<dim>>>         interaction;
    std::vector<typename BoundaryConditions<dim>::Named> conditions;
  };

  /** An empty set of variables that cells have in a scene's expressions. */
  template <int dim>
  StateColumns<dim>
  state_columns_of(const Scene &scene);

  /** What a scene offers to its effects, which add to the columns.
   *  @throws InputError */
  template <int dim>
  EffectSetting<dim>
  effect_setting(const Scene       &scene,
                 CellColumns<dim>  &columns,
                 StateColumns<dim> &state);

  /** Makes all effects of a scene, for TissueModel. @throws InputError */
  template <int dim>
  SceneEffects<dim>
  effects_of(const Scene &scene);

  /** The material and all effects of a scene, which are made once, before the
   *  tissue is seeded. Nothing in it changes. */
  template <int dim>
  struct TissueModel
  {
    /** @throws InputError */
    explicit TissueModel(const Scene &scene);

    const Scene          scene;
    const Redistribution redistribution;
    const Tables<dim>    tables;
    /** SceneEffects::all() */
    const std::vector<const Effect<dim> *> all_effects;
    /** The types of cells, or null. */
    const Fate<dim> *const types;
    /** Whether changes of type see the types of the cells around. */
    const bool                                           sees_neighbours;
    const TissueMaterial                                 material;
    const BoundaryConditions<dim>                        boundary_conditions;
    const CellDevelopment<dim>                           development;
    const NamedEffects<Equation<dim>>                    equations;
    const std::vector<std::unique_ptr<const Trait<dim>>> traits;
    const NamedEffects<StepEffect<dim>>                  step_effects;
    const NamedEffects<Force<dim>>                       forces;
    const std::optional<NamedEffect<Interaction<dim>>>   interaction;
    /** Equation::densities() of all. */
    const std::vector<Column<double>> densities;
    /** Of step effects, then of conditions, with the effects' names. */
    const std::vector<std::pair<std::string, const Moments<dim> *>> moments;

    /** Whether the surface of body number @p body is made from its cells, as
     *  Tissue/Surface says, and not tracked. */
    bool
    remakes_surface(const unsigned int body) const;

    /** Whether that of some body @p is_remade. */
    bool
    any_surface(const bool is_remade) const;

    /** The columns of the boundary points that the scene needs. */
    BoundaryColumns<dim>
    boundary_columns() const;

    /** An empty tissue whose cells and boundary points have the columns that
     *  the effects need. */
    Tissue<dim>
    empty_tissue(const MPI_Comm comm) const
    {
      return {scene.grid, development.columns(), comm, boundary_columns()};
    }

    /** The largest Young's modulus of the tissue, kPa. Collective.
     *  @param growth of the step, used if moduli depend on the state of cells
     */
    double
    typical_stiffness(const Tissue<dim>            &tissue,
                      const DevelopmentOfStep<dim> &growth,
                      const MPI_Comm                comm) const;

    /** Leaves a cell its amounts, doc/theory.md (11.4), when its volume has
     *  changed by the factor @p ratio. */
    void
    dilute(const CellView<dim, double> &cell, const double ratio) const
    {
      for (const Column<double> &density : densities)
        cell.set(density, cell.get(density) / ratio);
    }

  private:
    TissueModel(const Scene &scene, SceneEffects<dim> &&effects);
  };
} // namespace Morula

#endif
