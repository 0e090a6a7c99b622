// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_catalogue_h
#define morula_effects_catalogue_h

#include <morula/effects/choice.h>
#include <morula/effects/division/division_rule.h>
#include <morula/effects/equation.h>
#include <morula/effects/fate/fate.h>
#include <morula/effects/forces/force.h>
#include <morula/effects/growth/flow.h>
#include <morula/effects/growth/growth_factor.h>
#include <morula/effects/growth/growth_law.h>
#include <morula/effects/interaction.h>
#include <morula/effects/state/trait.h>
#include <morula/effects/step_effect.h>
#include <morula/effects/surface/boundary_condition.h>
#include <morula/mechanics/materials/material.h>

#include <deal.II/base/exceptions.h>

#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * The effects that scenes can have, by kind: the library's own, and those
   * that a program adds. A plain object, given to Scene::read();
   * doc/steps/step-7.md shows how to use it. Names are small letters, blanks
   * and '-'; the section of an effect is its name with a capital letter.
   */
  class Catalogue
  {
  public:
    /** See Choice::example(). */
    using Settings = std::vector<std::string>;

    /** The library's own effects. */
    Catalogue();

    /** Adds a law that `Growth/Law` can name; its keys stand in
     *  `Growth/<Name>`. See Choice::of(). */
    template <template <int> class Law>
    void
    add_growth_law(const std::string &name, const Settings &example = {})
    {
      add_in_section<Law>(growth_laws, "Growth/", name, example);
    }

    /** Adds a rule that `Proliferation/Cell cycle/Division axis` can name; its
     *  keys stand in `Proliferation/Cell cycle/<Name>`. */
    template <template <int> class Rule>
    void
    add_division_rule(const std::string &name, const Settings &example = {})
    {
      add_in_section<Rule>(division_rules,
                           "Proliferation/Cell cycle/",
                           name,
                           example);
    }

    /** Adds a force. A scene has it if its keys say so; they stand in `<Name>`.
     */
    template <template <int> class AddedForce>
    void
    add_force(const std::string &name, const Settings &example = {})
    {
      add_in_section<AddedForce>(forces, "", name, example);
    }

    /** Adds a factor of F_g, left of those before. A scene has it if its keys
     *  say so; they stand in `<Name>`. */
    template <template <int> class Factor>
    void
    add_growth_factor(const std::string &name, const Settings &example = {})
    {
      add_in_section<Factor>(growth_factors, "", name, example);
    }

    /** Adds a flow, which acts after those before. A scene has it if its keys
     *  say so; they stand in `<Name>`. */
    template <template <int> class AddedFlow>
    void
    add_flow(const std::string &name, const Settings &example = {})
    {
      add_in_section<AddedFlow>(flows, "", name, example);
    }

    /** Adds a trait. A scene has it if its keys say so; they stand in `<Name>`.
     */
    template <template <int> class AddedTrait>
    void
    add_trait(const std::string &name, const Settings &example = {})
    {
      add_in_section<AddedTrait>(traits, "", name, example);
    }

    /** Adds a step effect, whose moments come after those before. A scene has
     * it if its keys say so; they stand in `<Name>`. */
    template <template <int> class Added>
    void
    add_step_effect(const std::string &name, const Settings &example = {})
    {
      add_in_section<Added>(step_effects, "", name, example);
    }

    /** Adds a fate, which is asked after those before. A scene has it if its
     *  keys say so; they stand in `<Name>`. */
    template <template <int> class AddedFate>
    void
    add_fate(const std::string &name, const Settings &example = {})
    {
      add_in_section<AddedFate>(fates, "", name, example);
    }

    /** Adds an equation, found after those before. A scene has it if its keys
     *  say so; they stand in `<Name>`. */
    template <template <int> class Added>
    void
    add_equation(const std::string &name, const Settings &example = {})
    {
      add_in_section<Added>(equations, "", name, example);
    }

    /** Adds an interaction of bodies. A scene has it if its keys say so; they
     *  stand in `<Name>`. */
    template <template <int> class Added>
    void
    add_interaction(const std::string &name, const Settings &example = {})
    {
      add_in_section<Added>(interactions, "", name, example);
    }

    /** Adds a condition on the surface. A scene has it if its keys say so; they
     *  stand in `Boundary conditions/<Name>`. */
    template <template <int> class Condition>
    void
    add_boundary_condition(const std::string &name,
                           const Settings    &example = {})
    {
      add_in_section<Condition>(boundary_conditions,
                                "Boundary conditions/",
                                name,
                                example);
    }

    /** The keys of an effect, by their type. */
    template <typename Parameters>
    Parameters &
    keys()
    {
      return keys_of<Parameters>(*this);
    }

    /** The keys of an effect, by their type. */
    template <typename Parameters>
    const Parameters &
    keys() const
    {
      return keys_of<const Parameters>(*this);
    }

    /** The keys of each effect, kind by kind. */
    std::vector<EffectKeys *>
    all_keys();
    std::vector<const EffectKeys *>
    all_keys() const;

    /** The name and the Choice::example() of each effect, kind by kind. */
    std::vector<std::pair<std::string, Settings>>
    examples() const;

    /** The tensions of the cells' types. @throws InputError if keys contradict
     *  each other */
    TypeTensions
    tensions() const;

    /** The fields of all effects, in the order of their numbers. */
    std::vector<NamedField>
    named_fields() const;

    /** A copy whose keys have their defaults. */
    Catalogue
    with_defaults() const;

    /** The materials that `Material/Law` can name. A program adds one by
     *  materials.add("soft", own_material(Soft())). */
    Materials materials;

    Choices<GrowthLaw>         growth_laws;
    Choices<DivisionRule>      division_rules;
    Choices<GrowthFactor>      growth_factors;
    Choices<Flow>              flows;
    Choices<Fate>              fates;
    Choices<Equation>          equations;
    Choices<Trait>             traits;
    Choices<StepEffect>        step_effects;
    Choices<Force>             forces;
    Choices<BoundaryCondition> boundary_conditions;
    Choices<Interaction>       interactions;

  private:
    /** Adds an effect whose keys stand in @p around and a section of its own.
     */
    template <template <int> class Added, template <int> class Interface>
    void
    add_in_section(Choices<Interface> &choices,
                   const std::string  &around,
                   const std::string  &name,
                   const Settings     &example)
    {
      check_name(name);
      choices.push_back(Choice<Interface>::template of<Added>(
        name, section(around, name), example));
    }

    /** Calls @p action for all effects of all kinds of a catalogue, which may
     *  be constant. */
    template <typename Self, typename Action>
    static void
    for_each(Self &self, const Action &action)
    {
      const auto of_kind = [&action](auto &choices) {
        for (auto &choice : choices)
          action(choice);
      };
      of_kind(self.growth_laws);
      of_kind(self.division_rules);
      of_kind(self.growth_factors);
      of_kind(self.flows);
      of_kind(self.fates);
      of_kind(self.equations);
      of_kind(self.traits);
      of_kind(self.step_effects);
      of_kind(self.forces);
      of_kind(self.boundary_conditions);
      of_kind(self.interactions);
    }

    /** The first keys of a type. */
    template <typename Parameters, typename Self>
    static Parameters &
    keys_of(Self &self)
    {
      Parameters *found = nullptr;
      for_each(self, [&found](auto &choice) {
        if (found == nullptr)
          found = dynamic_cast<Parameters *>(&choice.keys());
      });
      AssertThrow(found != nullptr, ExcMessage("No effect has such keys."));
      return *found;
    }

    /** @throws std::invalid_argument for names that are in use or that a .prm
     *  file cannot hold */
    void
    check_name(const std::string &name);

    /** Where the keys of an added effect stand. */
    static std::string
    section(const std::string &around, std::string name);
  };
} // namespace Morula

#endif
