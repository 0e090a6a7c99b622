// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_scene_keys_h
#define morula_effects_scene_keys_h

#include <morula/base/time_parameters.h>
#include <morula/base/tissue_parameters.h>
#include <morula/effects/catalogue.h>
#include <morula/effects/division/division_rule.h>
#include <morula/effects/fate/cell_types.h>
#include <morula/grid/grid_parameters.h>
#include <morula/mechanics/material.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace Morula
{
  /** The keys of a scene that effects may see, and what follows from them. */
  struct SceneKeys : public Keys
  {
    /** @param catalogue effects that the scene may have, with their defaults */
    explicit SceneKeys(const Catalogue &catalogue);

    Key<unsigned int>   dimension;
    TimeParameters      time;
    TissueParameters    tissue;
    GridParameters      grid;
    MaterialParameters  material;
    Key<std::string>    growth_law;
    DivisionParameters  division;
    CellTypesParameters cell_types;

    /** The effects, with the values of their keys. */
    Catalogue catalogue;

    /**
     * The values of the keys as the file and the overrides wrote them, by full
     * path; what is missing has its default. It tells check() whether an effect
     * was switched off or forgotten.
     */
    std::map<std::string, std::string> as_written;

    /** The growth law of all types of cells that grow; "none" if there is none.
     */
    std::string
    law_of_growth() const
    {
      // A scene has one law. If it is not set for all cells, the first type
      // that has one tells.
      if (growth_law != "none")
        return growth_law;
      for (const CellTypeKeys &type : cell_types.types)
        if (!type.growth_law->empty() && type.growth_law != "none")
          return type.growth_law;
      return "none";
    }

    /** `Division axis` of types that have none of their own. */
    const std::string &
    division_axis() const
    {
      // A cell that does not grow by the fate that divides it may have grown
      // along any axis, so it is the long one that is to be cut, unless the
      // scene says otherwise.
      static const std::string shape = "cell shape";
      return cells_divide() && !grows_by_fate() && !has_set(division.axis) ?
               shape :
               division.axis.value();
    }

    /** `Division axis` of the type of cells number @p type. */
    const std::string &
    division_axis(const unsigned int type) const
    {
      const bool has_own =
        cell_types.is_on() && !cell_types.types[type].division_axis->empty();
      return has_own ? cell_types.types[type].division_axis.value() :
                       division_axis();
    }

    /** The division axes of all types. */
    std::set<std::string>
    division_axes() const
    {
      std::set<std::string> axes;
      for (unsigned int type = 0;
           type < std::max<std::size_t>(1, cell_types.types.size());
           ++type)
        axes.insert(division_axis(type));
      return axes;
    }

    /** Whether there is a growth law. */
    bool
    has_growth() const
    {
      return law_of_growth() != "none";
    }

    /** Whether cells of the type number @p type grow by the law. */
    bool
    grows(const unsigned int type) const
    {
      if (!cell_types.is_on() || cell_types.types[type].growth_law->empty())
        return growth_law != "none";
      return cell_types.types[type].growth_law != "none";
    }

    /** Whether some effect of a kind is on, which its keys switch on. */
    template <template <int> class Interface>
    static bool
    has_any(const Choices<Interface> &choices)
    {
      return std::any_of(choices.begin(), choices.end(), [](const auto &c) {
        return c.keys().is_on();
      });
    }

    /** Whether anything lets the tissue grow, shrink or change its shape. */
    bool
    has_active_tissue() const
    {
      return has_growth() || has_any(catalogue.growth_factors) ||
             grows_by_fate();
    }

    /** Whether the shear of some cells relaxes. */
    bool
    flows() const
    {
      return has_any(catalogue.flows);
    }

    /** Whether cells divide, by one of the fates. */
    bool
    cells_divide() const;

    /** The keys of the first effect by which cells may divide, and which has a
     *  switch; or null. */
    const EffectKeys *
    first_way_to_divide() const
    {
      for (const auto &choice : catalogue.fates)
        if (const EffectFacts facts = choice.keys().facts();
            facts.divides_cells && facts.switch_key != nullptr)
          return &choice.keys();
      return nullptr;
    }

    /** Whether cells grow by one of the fates. */
    bool
    grows_by_fate() const;

    /** The names of the types of cells, by their numbers; empty: all cells are
     *  alike. */
    std::vector<std::string>
    type_names() const
    {
      return cell_types.name_list();
    }

    /** The names of the fields of cells, by their numbers. */
    std::vector<std::string>
    field_names() const
    {
      std::vector<std::string> names;
      for (const NamedField &field : catalogue.named_fields())
        names.push_back(field.name);
      return names;
    }

    /** The names of the variables of the scene's own: of the fields, by their
     *  numbers, and then of columns of cells. */
    std::vector<std::string>
    own_variables() const
    {
      std::vector<std::string>       names = field_names();
      const std::vector<std::string> more  = catalogue.number_names();
      names.insert(names.end(), more.begin(), more.end());
      return names;
    }

    /** The keys of all effects: first those that are no entry of the catalogue.
     */
    std::vector<const EffectKeys *>
    effect_keys() const
    {
      std::vector<const EffectKeys *> list{&division, &cell_types};
      for (const EffectKeys *const keys : catalogue.all_keys())
        list.push_back(keys);
      return list;
    }

    /** Those of the effects that the scene has. */
    std::vector<const EffectKeys *>
    keys_in_use() const;

    /** Whether volumes of cells may differ. */
    bool
    volumes_differ() const
    {
      // Volumes differ where cells have grown, or were born, to different ones.
      return has_active_tissue() || has_any(catalogue.fates) ||
             tissue.is_points() || tissue.surface_cells == "trimmed";
    }

    /** The keys of an effect, by their type: e.g. keys<FixedParameters>(). */
    template <typename Parameters>
    Parameters &
    keys()
    {
      return catalogue.keys<Parameters>();
    }

    /** The keys of an effect, by their type. */
    template <typename Parameters>
    const Parameters &
    keys() const
    {
      return catalogue.keys<Parameters>();
    }

    /** Whether the file or an override has set the key. */
    bool
    has_set(const AnyKey &key) const
    {
      return as_written.count(key.path()) > 0;
    }
  };
} // namespace Morula

#endif
