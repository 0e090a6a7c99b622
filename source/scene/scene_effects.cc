// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/division/axis_rules.h>
#include <morula/effects/division/division_axes.h>
#include <morula/effects/fate/types_around.h>
#include <morula/effects/growth/forgetting.h>
#include <morula/effects/state/direction.h>
#include <morula/scene/scene.h>
#include <morula/seeding/shape.h>

#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

// This file makes all effects of a scene. Effects of equal scenes are equal,
// and have equal columns.

namespace Morula
{
  namespace
  {
    /** The centre of the tissue, µm: the origin for cells from a file. */
    template <int dim>
    Point<dim>
    center_of(const TissueParameters &tissue)
    {
      return tissue.is_from_file() ? Point<dim>() :
                                     leading_components<dim>(tissue.center);
    }

    /** Volume of whole cells where some are cut, µm^dim; else 0. */
    template <int dim>
    double
    whole_volume(const TissueParameters &tissue)
    {
      return tissue.surface_cells == "trimmed" && !tissue.is_from_file() ?
               std::pow(tissue.cell_spacing.value(), dim) :
               0.;
    }

    /** Makes each of the rules that types of cells have once. @param make makes
     *  one of the catalogue's effects */
    template <int dim, typename Make>
    DivisionRules<dim>
    rules_of(const Scene              &scene,
             const EffectSetting<dim> &setting,
             const Make               &make)
    {
      // Types may share an axis, so each rule is made once, by its name, and
      // types point to it. The random axis is no rule: it is a null pointer.
      DivisionRules<dim>                               all;
      std::map<std::string, const DivisionRule<dim> *> rules;
      for (const std::string &axis : scene.division_axes())
        {
          const std::string field = field_of_gradient(axis);
          const auto       *choice =
            find_choice(scene.catalogue.division_rules, axis);
          rules[axis] = nullptr;
          if (field.empty() && choice == nullptr)
            continue;
          if (field.empty())
            all.list.push_back(make(*choice));
          else
            all.list.push_back(
              std::make_unique<GradientAxis<dim>>(field, setting));
          rules[axis] = all.list.back().get();
        }
      for (unsigned int type = 0; type < scene.cell_types.types.size(); ++type)
        all.of_type.push_back(rules.at(scene.division_axis(type)));
      return all;
    }

    template <int dim>
    std::optional<NamedEffect<Interaction<dim>>>
    make_interaction(const Scene &scene, const EffectSetting<dim> &setting)
    {
      for (const auto &choice : scene.catalogue.interactions)
        if (choice.keys().is_on())
          return NamedEffect<Interaction<dim>>{
            choice.name(), choice.template make<dim>(setting)};
      return {};
    }
  } // namespace


  template <int dim>
  StateColumns<dim>
  state_columns_of(const Scene &scene)
  {
    StateColumns<dim>             state(scene.type_names(),
                            scene.field_names(),
                            scene.catalogue.neighbour_variables());
    const std::vector<NamedField> fields = scene.catalogue.named_fields();
    for (unsigned int k = 0; k < fields.size(); ++k)
      state.carried[k] = fields[k].exchanged;
    return state;
  }


  template <int dim>
  EffectSetting<dim>
  effect_setting(const Scene       &scene,
                 CellColumns<dim>  &columns,
                 StateColumns<dim> &state)
  {
    return {scene.random_seed,
            scene.time.slack(),
            columns,
            state,
            center_of<dim>(scene.tissue),
            scene.catalogue.tensions(),
            scene.catalogue.neighbour_search(),
            whole_volume<dim>(scene.tissue)};
  }


  template <int dim>
  SceneEffects<dim>
  effects_of(const Scene &scene)
  {
    // The order decides the columns of a cell, which snapshots and outputs
    // list, so it is fixed. Types come first, because expressions compare
    // `type`; then fates that grow cells, law, rules and factors; flows after
    // them, since they need to know whether a cycle keeps what has relaxed.
    // Columns of the state itself come last, when it is known which variables
    // any expression reads.
    SceneEffects<dim> effects;
    effects.state = state_columns_of<dim>(scene);
    effects.state.declare_types(effects.columns);
    effects.state.use(scene.material.youngs_modulus);
    effects.state.use(scene.material.poissons_ratio);
    DevelopmentEffects<dim> &development = effects.development;
    if (scene.has_growth())
      effects.columns.need_growth();
    const EffectSetting<dim> setting =
      effect_setting(scene, effects.columns, effects.state);
    effects.interaction = make_interaction(scene, setting);
    if (effects.interaction)
      effects.columns.need_bodies(
        effects.interaction->effect->acts_within_bodies());
    // An effect that has declared columns is told of every cell's begin and
    // advance.
    const auto make = [&](const auto &choice) {
      const unsigned int n      = effects.columns.n_numbers();
      auto               effect = choice.template make<dim>(setting);
      if (effects.columns.n_numbers() > n)
        development.with_state.push_back(effect.get());
      return effect;
    };
    const auto make_all = [&](const auto &choices, const auto &add) {
      for (const auto &choice : choices)
        if (choice.keys().is_on())
          add(choice.name(), make(choice));
    };

    const Catalogue                        &catalogue = scene.catalogue;
    std::vector<std::unique_ptr<Fate<dim>>> fates;
    const auto make_fates = [&](const bool that_grow) {
      for (const auto &choice : catalogue.fates)
        if (choice.keys().is_on() && choice.keys().grows_cells() == that_grow)
          {
            fates.push_back(make(choice));
            // The dead may shrink, whatever else grows.
            if (fates.back()->is_deadly())
              effects.columns.need_growth();
          }
    };
    make_fates(true);
    std::unique_ptr<CellTypes<dim>> types;
    if (scene.cell_types.is_on())
      {
        types = std::make_unique<CellTypes<dim>>(scene.cell_types, setting);
        for (unsigned int type = 0; type < types->size(); ++type)
          {
            development.grows.push_back(scene.grows(type));
            for (const Expression *const rate : types->rates(type))
              if (reads_types_around(*rate, effects.state))
                development.neighbours = catalogue.neighbour_search();
          }
      }
    if (scene.has_growth())
      development.law =
        make(*find_choice(catalogue.growth_laws, scene.law_of_growth()));
    std::shared_ptr<const DivisionAxes<dim>> axes;
    if (scene.cells_divide())
      axes = std::make_shared<const DivisionAxes<dim>>(scene.division,
                                                       effects.state,
                                                       rules_of(scene,
                                                                setting,
                                                                make),
                                                       scene.random_seed);
    make_all(catalogue.growth_factors, [&](const auto &, auto factor) {
      development.factors.push_back(std::move(factor));
    });
    const auto identity = Tensor<2, dim>(unit_symmetric_tensor<dim>());
    // A factor left of F_law hides it in the product, so it needs a column.
    if (scene.has_growth() && !development.factors.empty())
      development.law_growth = effects.columns.template add<Tensor<2, dim>>(
        {"law_growth", "", "F_g of the growth law", identity});
    if (types && scene.material.forgets_stress())
      {
        effects.columns.need_growth();
        development.flows.push_back(std::make_unique<Forgetting<dim>>());
      }
    make_all(catalogue.flows, [&](const auto &, auto flow) {
      development.flows.push_back(std::move(flow));
    });
    // Where cells grow by a fate F_r is a factor of the growth before it.
    if (!development.flows.empty() && !scene.grows_by_fate())
      development.relaxed = effects.columns.relaxed =
        effects.columns.template add<Tensor<2, dim>>(
          {"relaxed", "", "F_r, what has relaxed of F_g", identity});

    // The order of fates decides between two events at the same time: that of
    // the later fate happens. So a change of type comes before a death, and
    // both before the division.
    make_fates(false);
    if (types)
      fates.push_back(std::move(types));
    for (std::unique_ptr<Fate<dim>> &fate : fates)
      {
        fate->set_axes(axes);
        development.add_fate(std::move(fate));
      }
    make_all(catalogue.traits, [&](const auto &, auto trait) {
      effects.traits.push_back(std::move(trait));
    });
    make_all(catalogue.step_effects, [&](const auto &name, auto effect) {
      effects.step_effects.push_back({name, std::move(effect)});
    });
    make_all(catalogue.forces, [&](const auto &name, auto force) {
      effects.forces.push_back({name, std::move(force)});
    });
    make_all(catalogue.boundary_conditions,
             [&](const auto &name, auto condition) {
               effects.conditions.push_back({name, std::move(condition)});
             });
    // Equations read their cells themselves, and give them their first values
    // before all others.
    for (const auto &choice : catalogue.equations)
      if (choice.keys().is_on())
        effects.equations.push_back(
          {choice.name(), choice.template make<dim>(setting)});
    effects.state.declare(effects.columns);
    return effects;
  }


  template <int dim>
  std::vector<const Effect<dim> *>
  SceneEffects<dim>::all() const
  {
    // The order is that of the columns of the tables. Types are a fate, too,
    // but their columns come first.
    std::vector<const Effect<dim> *> list;
    if (development.types != nullptr)
      list.push_back(development.types);
    for (const auto &fate : development.fates)
      if (fate.get() != development.types)
        list.push_back(fate.get());
    if (development.law)
      list.push_back(development.law.get());
    for (const auto &factor : development.factors)
      list.push_back(factor.get());
    for (const auto &flow : development.flows)
      list.push_back(flow.get());
    for (const auto &trait : traits)
      list.push_back(trait.get());
    for (const auto &[name, effect] : step_effects)
      list.push_back(effect.get());
    for (const auto &[name, force] : forces)
      list.push_back(force.get());
    if (interaction)
      list.push_back(interaction->effect.get());
    return list;
  }


  template <int dim>
  Tables<dim>
  SceneEffects<dim>::tables() const
  {
    Tables<dim> tables;
    for (const Effect<dim> *const effect : all())
      effect->declare(tables);
    for (const auto &[name, condition] : conditions)
      condition->declare(tables);
    for (const auto &[name, equation] : equations)
      equation->declare(tables);
    return tables;
  }


  MORULA_INSTANTIATE(state_columns_of);
  MORULA_INSTANTIATE(effect_setting);
  MORULA_INSTANTIATE(effects_of);
  template struct SceneEffects<2>;
  template struct SceneEffects<3>;
} // namespace Morula
