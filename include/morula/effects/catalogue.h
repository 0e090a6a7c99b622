// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_catalogue_h
#define morula_effects_catalogue_h

#include <morula/effects/division/division_rule.h>
#include <morula/effects/effect.h>
#include <morula/effects/equation.h>
#include <morula/effects/fate/fate.h>
#include <morula/effects/forces/force.h>
#include <morula/effects/growth/growth_law.h>
#include <morula/effects/interaction.h>
#include <morula/effects/step_effect.h>
#include <morula/effects/surface/boundary_condition.h>
#include <morula/mechanics/materials/material.h>

#include <deal.II/base/exceptions.h>

#include <cctype>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * An effect of one kind that a scene can have: its name, its keys with their
   * values, and a function that makes the effect from them. @p Interface is
   * GrowthLaw, ... Copies have values of their own.
   */
  template <template <int> class Interface>
  class Choice
  {
  public:
    /**
     * @tparam Effect an Interface with a type Parameters, the same in 2-D and
     *         3-D: an EffectKeys that holds the keys. The effect is made from
     *         it, and from an EffectSetting as well if its constructor takes
     *         one; it may throw InputError.
     * @param section in which the keys stand; empty: their paths are full
     * @param example see example()
     */
    template <template <int> class Effect>
    static Choice
    of(const std::string              &name,
       const std::string              &section,
       const std::vector<std::string> &example)
    {
      using Parameters = typename Effect<3>::Parameters;
      static_assert(
        std::is_same<Parameters, typename Effect<2>::Parameters>::value);
      Choice choice;
      choice.name_         = name;
      choice.section       = section;
      choice.example_      = example;
      choice.make_defaults = []() -> std::unique_ptr<EffectKeys> {
        return std::make_unique<Parameters>();
      };
      choice.clone = [](const EffectKeys &keys) -> std::unique_ptr<EffectKeys> {
        return std::make_unique<Parameters>(
          static_cast<const Parameters &>(keys));
      };
      choice.make_2 = &make_effect<2, Effect>;
      choice.make_3 = &make_effect<3, Effect>;
      choice.reset();
      return choice;
    }

    /** Whether an effect is of this kind. */
    template <template <int> class Effect>
    static constexpr bool
    has()
    {
      return std::is_base_of<Interface<3>, Effect<3>>::value;
    }

    Choice(const Choice &other)
    {
      *this = other;
    }

    Choice &
    operator=(const Choice &other)
    {
      name_         = other.name_;
      section       = other.section;
      example_      = other.example_;
      make_defaults = other.make_defaults;
      clone         = other.clone;
      make_2        = other.make_2;
      make_3        = other.make_3;
      keys_         = other.clone(*other.keys_);
      return *this;
    }

    /** Its name in the scene, e.g. "stress limited". */
    const std::string &
    name() const
    {
      return name_;
    }

    /** Settings "PATH=value" by which a small ball of cells has the effect, in
     *  2-D and 3-D, in four steps of a tenth of a day: what the tests of all
     *  effects try it with. They are the same if x and y are exchanged; one of
     *  one dimension alone says "Dimension=2" or "Dimension=3". */
    const std::vector<std::string> &
    example() const
    {
      return example_;
    }

    /** Whether its keys have a section of their own. */
    bool
    has_section() const
    {
      return !section.empty();
    }

    /** Gives all keys their defaults. */
    void
    reset()
    {
      keys_ = make_defaults();
      if (!section.empty())
        for (AnyKey *key : keys_->list())
          key->place_in(section);
    }

    /** The keys with their values. */
    EffectKeys &
    keys()
    {
      return *keys_;
    }

    /** The keys with their values. */
    const EffectKeys &
    keys() const
    {
      return *keys_;
    }

    /** The effect with these values. @throws InputError */
    template <int dim>
    std::unique_ptr<Interface<dim>>
    make(const EffectSetting<dim> &setting) const
    {
      if constexpr (dim == 2)
        return make_2(*keys_, setting);
      else
        return make_3(*keys_, setting);
    }

  private:
    Choice() = default;

    template <int dim, template <int> class Effect>
    static std::unique_ptr<Interface<dim>>
    make_effect(const EffectKeys &keys, const EffectSetting<dim> &setting)
    {
      using Parameters       = typename Effect<dim>::Parameters;
      const auto &parameters = static_cast<const Parameters &>(keys);
      if constexpr (std::is_constructible<Effect<dim>,
                                          const Parameters &,
                                          const EffectSetting<dim> &>::value)
        return std::make_unique<Effect<dim>>(parameters, setting);
      else
        return std::make_unique<Effect<dim>>(parameters);
    }

    std::string                 name_, section;
    std::vector<std::string>    example_;
    std::unique_ptr<EffectKeys> keys_;
    std::unique_ptr<EffectKeys> (*make_defaults)();
    std::unique_ptr<EffectKeys> (*clone)(const EffectKeys &);
    std::unique_ptr<Interface<2>> (*make_2)(const EffectKeys &,
                                            const EffectSetting<2> &);
    std::unique_ptr<Interface<3>> (*make_3)(const EffectKeys &,
                                            const EffectSetting<3> &);
  };

  /** All effects of one kind, in the order in which they were added. */
  template <template <int> class Interface>
  using Choices = std::vector<Choice<Interface>>;

  /** The choice of this name, or null. */
  template <template <int> class Interface>
  const Choice<Interface> *
  find_choice(const Choices<Interface> &choices, const std::string &name)
  {
    for (const auto &choice : choices)
      if (choice.name() == name)
        return &choice;
    return nullptr;
  }

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

    /**
     * Adds an effect, behind those of its kind. The kind is the class that it
     * is derived from. A growth law is chosen by its name in `Growth/Law`, a
     * division rule in `Proliferation/Cell cycle/Division axis`; a scene has
     * others if their keys say so. The keys stand in a section `<Name>`, those
     * of a growth law in `Growth/<Name>`, of a division rule in
     * `Proliferation/Cell cycle/<Name>`, of a condition on the surface in
     * `Boundary conditions/<Name>`. See Choice::of().
     * @throws std::invalid_argument for names that are in use or that a .prm
     *         file cannot hold
     */
    template <template <int> class Added>
    void
    add(const std::string &name, const Settings &example = {})
    {
      check_name(name);
      add_own<Added>(name, example, true);
    }

    /** Adds an effect of the library: unless it @p has_section, its keys know
     *  their full paths. */
    template <template <int> class Added>
    void
    add_own(const std::string &name,
            const Settings    &example,
            const bool         has_section = false)
    {
      for_each_kind(*this, [&](auto &choices, const std::string &around) {
        using Kind = typename std::decay_t<decltype(choices)>::value_type;
        if constexpr (Kind::template has<Added>())
          choices.push_back(Kind::template of<Added>(
            name, has_section ? section(around, name) : "", example));
      });
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
    all_keys()
    {
      std::vector<EffectKeys *> list;
      for_each(*this,
               [&list](auto &choice) { list.push_back(&choice.keys()); });
      return list;
    }
    std::vector<const EffectKeys *>
    all_keys() const
    {
      std::vector<const EffectKeys *> list;
      for_each(*this,
               [&list](const auto &choice) { list.push_back(&choice.keys()); });
      return list;
    }

    /** The tensions of the cells' types. @throws InputError if keys contradict
     *  each other */
    TypeTensions
    tensions() const;

    /** The fields of all effects, in the order of their numbers. */
    std::vector<NamedField>
    named_fields() const
    {
      std::vector<NamedField> all;
      for (const EffectKeys *const keys : all_keys())
        for (const NamedField &field : keys->facts().fields)
          all.push_back(field);
      return all;
    }

    /** The columns that are variables, of the effects that are on. */
    std::vector<std::string>
    number_names() const
    {
      std::vector<std::string> all;
      for (const EffectKeys *const keys : all_keys())
        if (const auto names = keys->facts().numbers;
            !names.empty() && keys->is_on())
          all.insert(all.end(), names.begin(), names.end());
      return all;
    }

    /** A copy whose keys have their defaults. */
    Catalogue
    with_defaults() const
    {
      // The values of keys live in the choices, so a copy that is read into
      // must begin with the defaults. Otherwise a scene would see what the one
      // before it set.
      Catalogue copy(*this);
      for_each(copy, [](auto &choice) { choice.reset(); });
      return copy;
    }

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
    /** Calls @p action for all kinds of effects of a catalogue, which may be
     *  constant: with the choices, and the section around those of added ones.
     */
    template <typename Self, typename Action>
    static void
    for_each_kind(Self &self, const Action &action)
    {
      action(self.growth_laws, "Growth/");
      action(self.division_rules, "Proliferation/Cell cycle/");
      action(self.growth_factors, "");
      action(self.flows, "");
      action(self.fates, "");
      action(self.equations, "");
      action(self.traits, "");
      action(self.step_effects, "");
      action(self.forces, "");
      action(self.boundary_conditions, "Boundary conditions/");
      action(self.interactions, "");
    }

    /** Calls @p action for all effects of all kinds. */
    template <typename Self, typename Action>
    static void
    for_each(Self &self, const Action &action)
    {
      for_each_kind(self, [&action](auto &choices, const std::string &) {
        for (auto &choice : choices)
          action(choice);
      });
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

    void
    check_name(const std::string &name);

    /** Where the keys of an added effect stand. */
    static std::string
    section(const std::string &around, std::string name)
    {
      name[0] = std::toupper(static_cast<unsigned char>(name[0]));
      return around + name;
    }
  };
} // namespace Morula

#endif
