// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/scene_keys.h>

#include <algorithm>

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


  std::string
  SceneKeys::law_of_growth() const
  {
    // A scene has one law. If it is not set for all cells, the first type that
    // has one tells.
    if (growth_law != "none")
      return growth_law;
    for (const CellTypeKeys &type : cell_types.types)
      if (!type.growth_law->empty() && type.growth_law != "none")
        return type.growth_law;
    return "none";
  }


  const std::string &
  SceneKeys::division_axis() const
  {
    // A cell that does not grow by the fate that divides it may have grown
    // along any axis, so it is the long one that is to be cut, unless the scene
    // says otherwise.
    static const std::string shape = "cell shape";
    return cells_divide() && !grows_by_fate() && !has_set(division.axis) ?
             shape :
             division.axis.value();
  }


  const std::string &
  SceneKeys::division_axis(const unsigned int type) const
  {
    const bool has_own =
      cell_types.is_on() && !cell_types.types[type].division_axis->empty();
    return has_own ? cell_types.types[type].division_axis.value() :
                     division_axis();
  }


  std::set<std::string>
  SceneKeys::division_axes() const
  {
    std::set<std::string> axes;
    for (unsigned int type = 0;
         type < std::max<std::size_t>(1, cell_types.types.size());
         ++type)
      axes.insert(division_axis(type));
    return axes;
  }


  std::vector<const EffectKeys *>
  SceneKeys::effect_keys() const
  {
    std::vector<const EffectKeys *> list{&division, &cell_types};
    for (const EffectKeys *const keys : catalogue.all_keys())
      list.push_back(keys);
    return list;
  }


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


  const EffectKeys *
  SceneKeys::first_way_to_divide() const
  {
    for (const auto &choice : catalogue.fates)
      if (const EffectFacts facts = choice.keys().facts();
          facts.divides_cells && facts.switch_key != nullptr)
        return &choice.keys();
    return nullptr;
  }


} // namespace Morula
