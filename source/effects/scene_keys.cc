// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/scene_keys.h>

// What follows from the keys of a scene.

namespace Morula
{
  namespace
  {
    /** Whether a fate is on that does something. */
    bool
    has_fate_that(const Catalogue &catalogue, bool EffectFacts::*does)
    {
      return std::any_of(catalogue.fates.begin(),
                         catalogue.fates.end(),
                         [does](const auto &choice) {
                           return choice.keys().is_on() &&
                                  choice.keys().facts().*does;
                         });
    }
  } // namespace


  SceneKeys::SceneKeys(const Catalogue &catalogue)
    : dimension("Dimension",
                3,
                "3, or 2 for plane strain per um of thickness.",
                {2, 3})
    , material(catalogue.materials)
    , growth_law("Growth/Law",
                 "none",
                 "How cells grow without dividing.",
                 {"none"})
    , catalogue(catalogue)
  {}


  std::vector<const EffectKeys *>
  SceneKeys::keys_in_use() const
  {
    // Keys say whether their effect is on, but for those that others switch:
    // laws and rules by their names, and how cells divide.
    std::set<const EffectKeys *> off;
    const auto                   leave = [&off](const auto                  &choices,
                              const std::set<std::string> &chosen) {
      for (const auto &choice : choices)
        if (chosen.count(choice.name()) == 0)
          off.insert(&choice.keys());
    };
    leave(catalogue.growth_laws, {law_of_growth()});
    leave(catalogue.division_rules,
          cells_divide() ? division_axes() : std::set<std::string>());
    if (!cells_divide())
      off.insert(&division);
    std::vector<const EffectKeys *> list;
    for (const EffectKeys *const keys : effect_keys())
      if (off.count(keys) == 0 && keys->is_on())
        list.push_back(keys);
    return list;
  }


  bool
  SceneKeys::cells_divide() const
  {
    return has_fate_that(catalogue, &EffectFacts::divides_cells);
  }


  bool
  SceneKeys::grows_by_fate() const
  {
    return has_fate_that(catalogue, &EffectFacts::grows_cells);
  }


} // namespace Morula
