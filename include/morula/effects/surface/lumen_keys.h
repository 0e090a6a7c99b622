// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_lumen_keys_h
#define morula_effects_surface_lumen_keys_h

#include <morula/base/expression_key.h>
#include <morula/base/name_list.h>

#include <deque>
#include <string>
#include <vector>

namespace Morula
{
  /** The keys of one lumen: of the only one, in section "Boundary
   *  conditions", or of one with a name. */
  struct LumenKeys : public Keys
  {
    explicit LumenKeys(const std::string &name)
      : name(name)
    {}

    std::string name;

    ExpressionKey where{
      {this, path("Where")},
      "",
      "Expression of X, Y, Z: the boundary points for which it "
      "is > 0 enclose a lumen; empty: there is none.",
      Evaluated::founder};

    ExpressionKey volume{
      {this, path("Volume")},
      "",
      "Volume of the lumen relative to that at t = 0, a function of t; > 0. "
      "The pressure for that is computed, and written to statistics.csv. "
      "Empty: a gas fills the lumen.",
      Evaluated::place,
      positive("times the volume at t = 0", "1 keeps the volume.")};

    ExpressionKey pressure{
      {this, path("Pressure")},
      "",
      "Pressure of a gas in the lumen at the volume that this has at "
      "t = 0, V0, a function of t; at the volume V the pressure is V0/V "
      "times it. Empty: the volume is given. Units: kPa.",
      Evaluated::place};

    ExpressionKey secretion{
      {this, path("Secretion")},
      "",
      "Volume of fluid that the wall secretes into the lumen per area and "
      "time, a function of t; < 0: it takes it up. The pressure is computed. "
      "Empty: the volume is given, or there is a gas. Units: um/day.",
      Evaluated::place};

    /** The three ways to fill it. */
    std::vector<const ExpressionKey *>
    ways() const
    {
      return {&volume, &pressure, &secretion};
    }

  private:
    std::string
    path(std::string key) const
    {
      if (!name.empty())
        return "Lumens/" + name + "/" + key;
      key[0] += 'a' - 'A';
      return "Boundary conditions/Lumen " + key;
    }
  };


  /** The lumen without a name, and section "Lumens": names first, then a
   *  section for each of them. */
  struct LumensParameters : public EffectKeys
  {
    LumenKeys        one{""};
    Key<std::string> names{
      {this, "Lumens/Names"},
      "",
      "Spaces that the tissue encloses, separated by commas. Each has a "
      "section of this name. Empty: none, or that of Boundary "
      "conditions/Lumen where."};
    std::deque<LumenKeys> named;

    /** The lumens that the scene has. */
    std::vector<const LumenKeys *>
    all() const
    {
      std::vector<const LumenKeys *> all;
      if (!one.where.empty())
        all.push_back(&one);
      for (const LumenKeys &lumen : named)
        all.push_back(&lumen);
      return all;
    }
    bool
    is_on() const override
    {
      return !all().empty();
    }
    EffectFacts
    facts() const override
    {
      EffectFacts facts{&one.where};
      facts.names_key = &names;
      return facts;
    }
    void
    declare_sections(const std::string &text,
                     const std::vector<std::string> &) override
    {
      for (const std::string &name :
           declared_names(names, text, reason_against_variable))
        named.emplace_back(name);
    }
    using Keys::list;
    KeyList
    list() override
    {
      KeyList list = one.list();
      for (AnyKey *const key : keys_of_all(names, named))
        list.push_back(key);
      return list;
    }
  };
} // namespace Morula

#endif
