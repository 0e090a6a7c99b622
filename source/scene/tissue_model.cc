// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/division/division_rule.h>
#include <morula/effects/growth/relaxation.h>
#include <morula/effects/state/direction.h>
#include <morula/effects/state/neighbour_columns.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/scene/tissue_model.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

// All effects of a scene are made here. Effects of equal scenes are equal, and
// have equal columns.

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
  } // namespace


  template <int dim>
  StateColumns<dim>
  state_columns_of(const Scene &scene)
  {
    StateColumns<dim>             state(scene.type_names(),
                            scene.field_names(),
                            scene.catalogue.number_names(),
                            scene.keys<NeighbourParameters>().variables);
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
            scene.keys<NeighbourParameters>().search(),
            whole_volume<dim>(scene.tissue)};
  }


  namespace
  {
    /** Makes the effects of a scene, each in its turn. */
    template <int dim>
    class EffectMaker
    {
    public:
      EffectMaker(const Scene &scene, SceneEffects<dim> &effects)
        : scene(scene)
        , catalogue(scene.catalogue)
        , effects(effects)
        , development(effects.development)
        , setting(effect_setting(scene, effects.columns, effects.state))
      {}

      void
      make_interaction()
      {
        for (const auto &choice : catalogue.interactions)
          if (choice.keys().is_on() && !effects.interaction)
            effects.interaction =
              NamedEffect<Interaction<dim>>{choice.name(),
                                            choice.template make<dim>(setting)};
        if (effects.interaction)
          effects.columns.need_bodies(
            effects.interaction->effect->acts_within_bodies());
      }

      /** @param that_grow whether by them cells grow */
      void
      make_pools()
      {
        if (scene.material.volumetric_form() == VolumetricStrain::pooled)
          effects.columns.need_pools();
      }

      void
      make_fates(const bool that_grow)
      {
        for (const auto &choice : catalogue.fates)
          if (choice.keys().is_on() &&
              choice.keys().facts().grows_cells == that_grow)
            {
              fates.push_back(make(choice));
              // The dead may shrink, whatever else grows.
              if (dynamic_cast<const Dies<dim> *>(fates.back().get()) !=
                  nullptr)
                effects.columns.need_growth();
            }
      }

      void
      make_types()
      {
        types                    = make_cell_types(scene.cell_types, setting);
        development.types        = types.get();
        development.founder_type = [types =
                                      scene.cell_types](const Point<dim> &X) {
          return types.founder_type(X);
        };

        for (unsigned int type = 0; type < scene.cell_types.types.size();
             ++type)
          {
            development.grows.push_back(scene.grows(type));
            for (const CellHazard<dim> &way : types->hazards(type))
              if (reads_types_around(way.rate, effects.state))
                development.neighbours =
                  scene.keys<NeighbourParameters>().search();
          }
      }

      /** The law, the axes of division, and factors left of the law. */
      void
      make_growth()
      {
        if (scene.has_growth())
          development.law =
            make(*find_choice(catalogue.growth_laws, scene.law_of_growth()));
        if (scene.cells_divide())
          make_axes();
        make_all(catalogue.growth_factors, development.factors);
        // A factor left of F_law hides it in the product, so it needs a column.
        if (scene.has_growth() && !development.factors.empty())
          development.law_growth =
            add_tensor("law_growth", "F_g of the growth law");
      }

      void
      make_flows()
      {
        if (auto flow =
              flow_of_transitions(scene.material, setting, types != nullptr))
          {
            effects.columns.need_growth();
            development.flows.push_back(std::move(flow));
          }
        make_all(catalogue.flows, development.flows);
        // Where cells grow by a fate F_r is a factor of the growth before it.
        if (!development.flows.empty() && !scene.grows_by_fate())
          development.relaxed = effects.columns.relaxed =
            add_tensor("relaxed", "F_r, what has relaxed of F_g");
      }

      /** Gives the fates to the development, types at last. */
      void
      add_fates()
      {
        if (types)
          fates.push_back(std::move(types));
        for (std::unique_ptr<Fate<dim>> &fate : fates)
          {
            if (auto *const divides = dynamic_cast<Divides<dim> *>(fate.get()))
              divides->axes = axes;
            development.add_fate(std::move(fate));
          }
      }

      /** What acts on the tissue as a whole, and on its surface. */
      void
      make_others()
      {
        make_all(catalogue.traits, effects.traits);
        make_all(catalogue.step_effects, effects.step_effects);
        make_all(catalogue.forces, effects.forces);
        make_all(catalogue.boundary_conditions, effects.conditions);
        // Equations read their cells themselves, and give them their first
        // values before all others.
        for (const auto &choice : catalogue.equations)
          if (choice.keys().is_on())
            effects.equations.push_back(
              {choice.name(), choice.template make<dim>(setting)});
      }

    private:
      /** Along what cells divide. */
      void
      make_axes()
      {
        // Types may share an axis, so each rule is made once, by its name, and
        // types point to it. The random axis is no rule: it is a null pointer.
        typename DivisionAxes<dim>::Rules                all;
        std::map<std::string, const DivisionRule<dim> *> rules;
        for (const std::string &axis : scene.division_axes())
          {
            const std::string field = field_of_gradient(axis);
            const auto *const choice =
              find_choice(catalogue.division_rules, axis);
            rules[axis] = nullptr;
            if (field.empty() && choice == nullptr)
              continue;
            if (field.empty())
              all.push_back(make(*choice));
            else
              all.push_back(gradient_axis(field, setting));
            rules[axis] = all.back().get();
          }
        std::vector<const DivisionRule<dim> *> of_type;
        for (unsigned int i = 0; i < scene.cell_types.types.size(); ++i)
          of_type.push_back(rules.at(scene.division_axis(i)));
        axes = std::make_shared<const DivisionAxes<dim>>(scene.division,
                                                         effects.state,
                                                         scene.random_seed,
                                                         std::move(all),
                                                         of_type);
      }

      /** Makes an effect. One that has declared columns is told of every cell's
       *  begin and advance. */
      template <template <int> class Interface>
      std::unique_ptr<Interface<dim>>
      make(const Choice<Interface> &choice)
      {
        const unsigned int n      = effects.columns.n_numbers();
        auto               effect = choice.template make<dim>(setting);
        if (effects.columns.n_numbers() > n)
          development.with_state.push_back(effect.get());
        return effect;
      }

      /** Makes those of a kind that are on, for a list of effects, or of
       *  effects and names. */
      template <template <int> class Interface, typename List>
      void
      make_all(const Choices<Interface> &choices, List &list)
      {
        for (const auto &choice : choices)
          if (!choice.keys().is_on())
            continue;
          else if constexpr (std::is_aggregate_v<typename List::value_type>)
            list.push_back({choice.name(), make(choice)});
          else
            list.push_back(make(choice));
      }

      /** A column of cells that begins with the identity. */
      Column<Tensor<2, dim>>
      add_tensor(const std::string &name, const std::string &what)
      {
        return effects.columns.template add<Tensor<2, dim>>(
          {name, "", what, Tensor<2, dim>(unit_symmetric_tensor<dim>())});
      }

      const Scene                             &scene;
      const Catalogue                         &catalogue;
      SceneEffects<dim>                       &effects;
      DevelopmentEffects<dim>                 &development;
      const EffectSetting<dim>                 setting;
      std::vector<std::unique_ptr<Fate<dim>>>  fates;
      std::unique_ptr<Fate<dim>>               types;
      std::shared_ptr<const DivisionAxes<dim>> axes;
    };
  } // namespace


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
    if (scene.has_growth())
      effects.columns.need_growth();
    EffectMaker<dim> maker(scene, effects);
    maker.make_interaction();
    maker.make_pools();
    maker.make_fates(true);
    if (scene.cell_types.is_on())
      maker.make_types();
    maker.make_growth();
    maker.make_flows();
    // The order of fates decides between two events at the same time: that of
    // the later fate happens. So a change of type comes before a death, and
    // both before the division.
    maker.make_fates(false);
    maker.add_fates();
    maker.make_others();
    effects.state.declare(effects.columns);
    if (redistribution_of(scene).places)
      effects.columns.need_step_strain();
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
    for (const auto &fate : development.fates.list)
      if (fate.get() != development.types)
        list.push_back(fate.get());
    if (const Divides<dim> *const divides = development.fates.dividing;
        divides != nullptr && divides->axes)
      for (const auto &rule : divides->axes->rules)
        list.push_back(rule.get());
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
    , redistribution(redistribution_of(scene))
    , tables(effects.tables(redistribution))
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
        boundary_conditions.nitsche().kind() != NitscheForm::bounded)
      add_carriers(columns);
    for (const auto &named : boundary_conditions.list())
      named.condition->add_columns(columns);
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
        largest = std::max(largest,
                           material.youngs_modulus(
                             tissue.cells()[p].founder_position()));
    return Utilities::MPI::max(largest, comm);
  }


  MORULA_INSTANTIATE(state_columns_of);
  MORULA_INSTANTIATE(effect_setting);
  MORULA_INSTANTIATE(effects_of);
  template struct SceneEffects<2>;
  template struct SceneEffects<3>;
  template struct TissueModel<2>;
  template struct TissueModel<3>;
} // namespace Morula
