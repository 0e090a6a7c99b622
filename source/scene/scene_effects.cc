// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/division/axis_rules.h>
#include <morula/scene/scene.h>
#include <morula/seeding/shape.h>

#include <map>

// All effects of a scene are made here.

namespace Morula
{
  namespace
  {
    /** Where the tissue has its centre, µm. */
    template <int dim>
    Point<dim>
    center_of(const TissueParameters &tissue)
    {
      return tissue.is_from_file() ? Point<dim>() :
                                     leading_components<dim>(tissue.center);
    }

    /** Makes each of the rules that types of cells have once. @param make makes
     *  one of the catalogue's effects */
    template <int dim, typename Make>
    void
    add_rules(const Scene              &scene,
              const EffectSetting<dim> &setting,
              const Make               &make,
              DevelopmentEffects<dim>  &development)
    {
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
            development.rules.push_back(make(*choice));
          else
            development.rules.push_back(
              std::make_unique<GradientAxis<dim>>(field, setting));
          rules[axis] = development.rules.back().get();
        }
      for (unsigned int type = 0; type < scene.cell_types.types.size(); ++type)
        development.rule_of_type.push_back(rules.at(scene.division_axis(type)));
    }
  } // namespace


  template <int dim>
  SceneEffects<dim>
  effects_of(const Scene &scene)
  {
    SceneEffects<dim> effects;
    effects.state =
      StateColumns<dim>(scene.cell_types.name_list(), scene.fields.name_list());
    effects.state.declare_types(effects.columns);
    effects.state.use(scene.material.youngs_modulus);
    effects.state.use(scene.material.poissons_ratio);
    DevelopmentEffects<dim> &development = effects.development;
    if (scene.has_growth())
      effects.columns.need_growth();
    if (scene.has_proliferation())
      {
        const auto &cycle = development.cycle.emplace(scene.cell_cycle,
                                                      scene.random_seed,
                                                      scene.time.slack(),
                                                      effects.state);
        development.clock.emplace(effects.columns,
                                  cycle.has_own_duration(),
                                  cycle.has_own_hazard(),
                                  cycle.keeps_exit_rate(),
                                  cycle.has_checkpoint());
      }
    const EffectSetting<dim> setting{scene.random_seed,
                                     scene.time.slack(),
                                     effects.columns,
                                     effects.state,
                                     center_of<dim>(scene.tissue)};
    const auto               make = [&](const auto &choice) {
      const unsigned int n = effects.columns.n_numbers();
      auto               effect = choice.template make<dim>(setting);
      if (effects.columns.n_numbers() > n)
        development.with_state.push_back(effect.get());
      return effect;
    };

    if (scene.cell_types.present())
      {
        development.types.emplace(scene.cell_types, setting);
        for (unsigned int type = 0; type < development.types->size(); ++type)
          development.grows.push_back(scene.grows(type));
      }
    const Catalogue &catalogue = scene.catalogue;
    if (scene.has_growth())
      development.law =
        make(*find_choice(catalogue.growth_laws, scene.law_of_growth()));
    if (scene.has_proliferation())
      add_rules(scene, setting, make, development);
    if (scene.has_contraction())
      {
        development.contraction =
          std::make_unique<Contraction<dim>>(scene.contraction, setting);
        if (scene.has_growth())
          development.law_growth = effects.columns.template add<Tensor<2, dim>>(
            {"law_growth",
             "",
             "F_g of the growth law",
             Tensor<2, dim>(unit_symmetric_tensor<dim>())});
      }
    if (scene.material.relaxes())
      {
        effects.columns.need_growth();
        development.relaxation =
          std::make_unique<Relaxation<dim>>(scene.material,
                                            effects.state,
                                            effects.columns);
      }
    development.forgets_stress =
      scene.cell_types.present() && scene.material.forgets_stress();
    if ((development.relaxation || development.forgets_stress) &&
        !scene.has_proliferation())
      {
        effects.columns.need_growth();
        development.relaxed = effects.columns.template add<Tensor<2, dim>>(
          {"relaxed",
           "",
           "F_r, what has relaxed of F_g",
           Tensor<2, dim>(unit_symmetric_tensor<dim>())});
      }
    if (scene.has_death())
      development.death.emplace(scene.death, setting);
    for (const auto &choice : catalogue.fates)
      if (choice.keys().is_on())
        effects.fates.push_back(make(choice));
    for (const auto &choice : catalogue.forces)
      if (choice.keys().is_on())
        effects.forces.push_back({choice.name(), make(choice)});
    for (const auto &choice : catalogue.boundary_conditions)
      if (choice.keys().is_on())
        effects.conditions.push_back({choice.name(), make(choice)});
    if (scene.fields.present())
      effects.fields = Fields<dim>(scene.fields, setting);
    effects.state.declare(effects.columns);
    return effects;
  }


  template <int dim>
  BoundaryConditions<dim>
  boundary_conditions_of(const Scene &scene)
  {
    return {effects_of<dim>(scene).conditions, scene.nitsche};
  }


#define INSTANTIATE(dim)                                      \
  template SceneEffects<dim>       effects_of(const Scene &); \
  template BoundaryConditions<dim> boundary_conditions_of(const Scene &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
