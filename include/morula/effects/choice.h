// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_choice_h
#define morula_effects_choice_h

#include <morula/effects/effect.h>

#include <memory>
#include <string>
#include <type_traits>
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
} // namespace Morula

#endif
