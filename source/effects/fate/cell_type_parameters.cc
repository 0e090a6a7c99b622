// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/name_list.h>
#include <morula/effects/scene_keys.h>

namespace Morula
{
  namespace
  {
    // All keys of a type stand in the section of its name below this one.
    const std::string section_of_types = "Cell types/";
  } // namespace


  CellTypeKeys::CellTypeKeys(const std::string                        &name,
                             const std::vector<std::string>           &others,
                             const std::vector<const ExpressionKey *> &of_cells,
                             const std::string &growth_laws,
                             const std::string &division_axes)
    : name(name)
    , where("Where",
            "",
            "Founders for which this is > 0 are of this type; of several types "
            "the last one counts, and the first type is that of all others. An "
            "expression of X, Y, Z (um).",
            Evaluated::founder)
    , daughters("Daughter types",
                "",
                "Types of the two daughters, the one at -n_s first; empty: the "
                "mother's. E.g. stem, transit.")
    , growth_law("Growth/Law",
                 "",
                 "none, or the law by which cells of this type grow; empty: "
                 "that of all.",
                 {"|none|" + growth_laws})
    , proliferation_law(
        "Proliferation/Law",
        "",
        "none, or how cells of this type proliferate; empty: as all. Cells "
        "that are past the onset of S divide, and then wait.",
        {"|none|cell cycle"})
    , division_axis("Proliferation/Cell cycle/Division axis",
                    "",
                    "What n_s of cells of this type is when they enter S; "
                    "empty: that of all.",
                    {"|" + division_axes})
  {
    // The names of types are the user's, so their keys are made while the file
    // is read. A type has some keys of its own, one rate for each other type,
    // and a copy of every key of cells in the scene, which is empty unless the
    // type differs from the others. Paths are completed at the end: place_in()
    // puts the section before them.
    for (const std::string &other : others)
      {
        transitions.emplace_back("Transitions/To " + other,
                                 "0",
                                 "Rate at which cells of this type become " +
                                   other +
                                   ", an expression of their state; not "
                                   "negative. Units: 1/day.",
                                 Evaluated::step,
                                 not_negative("1/day",
                                              "0 lets cells keep their type."));
      }
    place_in(list(), section_of_types + name);
    for (const ExpressionKey *key : of_cells)
      overrides.push_back(key->in_section_of_type(section_of_types + name));
  }


  std::string
  CellTypeKeys::path_of(const AnyKey &key) const
  {
    return section_of_types + name + "/" + key.path();
  }


  KeyList
  CellTypeKeys::list()
  {
    KeyList list{&where, &daughters};
    for (ExpressionKey &key : transitions)
      list.push_back(&key);
    list.push_back(&growth_law);
    list.push_back(&proliferation_law);
    list.push_back(&division_axis);
    for (ExpressionKey &key : overrides)
      list.push_back(&key);
    return list;
  }


  std::vector<std::string>
  CellTypesParameters::name_list() const
  {
    return names_of(types);
  }


  void
  CellTypesParameters::make_types(
    const std::string                        &text,
    const std::vector<const ExpressionKey *> &of_cells,
    const std::string                        &growth_laws,
    const std::string                        &division_axes,
    const std::vector<std::string>           &fields)
  {
    // The text is that of the key Names, which is read before all others. First
    // all names are checked, then each type gets its keys: it has to know the
    // others, since they are what it may become.
    const std::vector<std::string> list =
      declared_names(names, text, [&](const std::string &name) {
        return std::find(fields.begin(), fields.end(), name) != fields.end() ?
                 "A field has this name: choose another one." :
                 reason_against_variable(name);
      });
    for (const std::string &name : list)
      {
        std::vector<std::string> others;
        std::copy_if(list.begin(),
                     list.end(),
                     std::back_inserter(others),
                     [&](const std::string &other) { return other != name; });
        types.emplace_back(name, others, of_cells, growth_laws, division_axes);
      }
  }


  void
  CellTypesParameters::apply(const std::vector<ExpressionKey *> &of_cells)
  {
    // First every expression learns the names of types as numbers, as it may
    // compare `type` with them. Then what a type overrides is put into the key
    // of all cells, by the type's number; an empty key leaves the scene's
    // value. The overrides of a type are in the order of `of_cells`.
    std::map<std::string, double> numbers;
    for (unsigned int i = 0; i < types.size(); ++i)
      numbers[types[i].name] = i;
    for (ExpressionKey *key : of_cells)
      key->set_types(numbers);
    for (unsigned int i = 0; i < types.size(); ++i)
      {
        for (ExpressionKey &rate : types[i].transitions)
          rate.set_types(numbers);
        for (std::size_t k = 0; k < of_cells.size(); ++k)
          {
            ExpressionKey &own = types[i].overrides[k];
            own.set_types(numbers);
            if (!own.empty())
              of_cells[k]->set_for_type(i, own.path(), own.text());
          }
      }
  }


  std::pair<unsigned int, unsigned int>
  CellTypesParameters::daughters(const unsigned int type) const
  {
    // An empty key stands for two daughters of the mother's type. The result
    // has numbers of types, the daughter at -n_s first.
    const Key<std::string>        &key  = types[type].daughters;
    const std::vector<std::string> both = split_names(key);
    if (both.empty())
      return {type, type};
    const std::vector<std::string> all = name_list();
    std::vector<unsigned int>      numbers;
    for (const std::string &name : both)
      {
        const auto found = std::find(all.begin(), all.end(), name);
        if (found == all.end())
          key.refuse("two of " + names, "There is no type '" + name + "'.");
        numbers.push_back(found - all.begin());
      }
    if (numbers.size() != 2)
      key.refuse("two of " + names,
                 "Name the types of both daughters, the one at -n_s first.");
    return {numbers[0], numbers[1]};
  }


  std::vector<const ExpressionKey *>
  CellTypesParameters::own_values_of(const AnyKey &key) const
  {
    // A type has a copy of every key of cells; it is found by its path.
    std::vector<const ExpressionKey *> list;
    for (const CellTypeKeys &type : types)
      for (const ExpressionKey &own : type.overrides)
        if (!own.empty() && own.path() == type.path_of(key))
          list.push_back(&own);
    return list;
  }


  std::string
  CellTypesParameters::details_of(const unsigned int type) const
  {
    std::string       lines;
    const std::size_t section =
      types[type].path_of(names).size() - names.path().size();
    for (const AnyKey *key : types[type].list())
      if (!key->is_default())
        lines +=
          "    " + key->path().substr(section) + " = " + key->text() + '\n';
    return lines;
  }


  void
  CellTypesParameters::check_founders(
    const std::vector<dealii::types::particle_index> &n) const
  {
    // A type without a condition of its own may be reached by transitions only,
    // so it may have no founder.
    for (unsigned int i = 0; i < types.size(); ++i)
      if (const ExpressionKey &where = types[i].where;
          n[i] == 0 && !where.empty())
        where.refuse("a condition that holds at some founder",
                     "It is positive at none, or at founders of later types "
                     "only: correct it, or leave it empty. Founders sit at "
                     "centers of cells, inside of the tissue.");
  }


  void
  CellTypesParameters::check(const SceneKeys &scene, Review &) const
  {
    const auto &on_transition = scene.material.on_transition;
    if (!is_on() && on_transition == "forget stress")
      on_transition.refuse("keep strain or keep stress, as there are no types "
                           "of cells",
                           "Set " + names.path() + ", or remove this key.");
    if (on_transition == "keep stress" &&
        !TissueMaterial(scene.material).depends_on_state())
      on_transition.refuse("its default, as no cell's stiffness ever changes",
                           "Let " + scene.material.youngs_modulus.path() +
                             " depend on time, age, type or what you like.");
    for (unsigned int i = 0; i < types.size(); ++i)
      {
        const CellTypeKeys &type = types[i];
        type.check_each(scene.dimension);
        daughters(i);
        if (!type.growth_law->empty() && type.growth_law != "none" &&
            type.growth_law != scene.law_of_growth())
          type.growth_law.refuse("none or " + scene.law_of_growth(),
                                 "A scene has one law of growth: give its keys "
                                 "other values for this type.");
      }
  }


  KeyList
  CellTypesParameters::list()
  {
    return keys_of_all(names, types);
  }
} // namespace Morula
