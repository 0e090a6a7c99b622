// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_catalogue_h
#define morula_scene_catalogue_h

#include <morula/base/parameter_keys.h>
#include <morula/effects/division/division_rule.h>
#include <morula/effects/growth/growth_law.h>

#include <deal.II/base/parameter_handler.h>

#include <any>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace Morula
{
  /**
   * An effect that a scene can choose by its name: its keys with their values,
   * and how it is made of them. @p Interface is GrowthLaw or DivisionRule.
   * Copies have values of their own.
   */
  template <template <int> class Interface>
  class Choice
  {
  public:
    /**
     * @tparam Effect an Interface with a type Parameters, the same in 2-D and
     *         3-D: the keys' values, at first the defaults, and
     *         declare(ParameterHandler &), which binds the keys to them. The
     *         effect is made from it, and may throw InputError.
     */
    template <template <int> class Effect>
    static Choice
    of(const std::string &name)
    {
      using Parameters = typename Effect<3>::Parameters;
      static_assert(
        std::is_same<Parameters, typename Effect<2>::Parameters>::value);
      Choice choice;
      choice.name_        = name;
      choice.defaults     = [] { return std::any(Parameters()); };
      choice.declare_keys = [](std::any &values, ParameterHandler &prm) {
        std::any_cast<Parameters &>(values).declare(prm);
      };
      choice.make_2 = &make_effect<2, Effect>;
      choice.make_3 = &make_effect<3, Effect>;
      choice.values = choice.defaults();
      return choice;
    }

    /** In the scene, e.g. "stress limited". */
    const std::string &
    name() const
    {
      return name_;
    }

    /** Of its keys: the name with a capital letter. */
    std::string
    section() const;

    /** The same effect with the defaults. */
    Choice
    with_defaults() const;

    /** Declares its section, bound to the values of this object. */
    void
    declare(ParameterHandler &prm);

    /** The keys in its section; their defaults are the values here. */
    std::vector<ParameterKey>
    keys() const;

    /** @throws InputError */
    template <int dim>
    std::unique_ptr<const Interface<dim>>
    make() const
    {
      if constexpr (dim == 2)
        return make_2(values);
      else
        return make_3(values);
    }

  private:
    template <int dim, template <int> class Effect>
    static std::unique_ptr<const Interface<dim>>
    make_effect(const std::any &values)
    {
      using Parameters = typename Effect<dim>::Parameters;
      return std::make_unique<const Effect<dim>>(
        std::any_cast<const Parameters &>(values));
    }

    std::string name_;
    std::any    values;
    std::any (*defaults)();
    void (*declare_keys)(std::any &, ParameterHandler &);
    std::unique_ptr<const Interface<2>> (*make_2)(const std::any &);
    std::unique_ptr<const Interface<3>> (*make_3)(const std::any &);
  };

  /**
   * The effects that a program adds to the library's own. A plain object, given
   * to Scene::read(); doc/steps/step-7.md shows how to use it.
   */
  class Catalogue
  {
  public:
    /** Adds a law that `Growth/Law` can name; its keys stand in
     *  `Growth/<Name>`. See Choice::of(). */
    template <template <int> class Law>
    void
    add_growth_law(const std::string &name)
    {
      check_name(name);
      growth_laws.push_back(Choice<GrowthLaw>::of<Law>(name));
    }

    /** Adds a rule that `Proliferation/Cell cycle/Division axis` can name; its
     *  keys stand in `Proliferation/Cell cycle/<Name>`. */
    template <template <int> class Rule>
    void
    add_division_rule(const std::string &name)
    {
      check_name(name);
      division_rules.push_back(Choice<DivisionRule>::of<Rule>(name));
    }

    /** The same effects with their defaults. */
    Catalogue
    with_defaults() const;

    std::vector<Choice<GrowthLaw>>    growth_laws;
    std::vector<Choice<DivisionRule>> division_rules;

  private:
    /** @throws std::invalid_argument for names that are in use or that a .prm
     *  file cannot hold */
    void
    check_name(const std::string &name) const;
  };

  /** The choice of this name, or null. */
  template <template <int> class Interface>
  const Choice<Interface> *
  find_choice(const std::vector<Choice<Interface>> &choices,
              const std::string                    &name)
  {
    for (const auto &choice : choices)
      if (choice.name() == name)
        return &choice;
    return nullptr;
  }

  /** "|first|second", for a pattern of names. */
  template <template <int> class Interface>
  std::string
  as_alternatives(const std::vector<Choice<Interface>> &choices)
  {
    std::string text;
    for (const auto &choice : choices)
      text += "|" + choice.name();
    return text;
  }
} // namespace Morula

#endif
