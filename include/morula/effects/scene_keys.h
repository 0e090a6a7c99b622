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
    law_of_growth() const;

    /** `Division axis` of types that have none of their own. */
    const std::string &
    division_axis() const;

    /** `Division axis` of the type of cells number @p type. */
    const std::string &
    division_axis(const unsigned int type) const;

    /** The division axes of all types. */
    std::set<std::string>
    division_axes() const;

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
    first_way_to_divide() const;

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

    /** The keys of all effects: first those that are no entry of the catalogue.
     */
    std::vector<const EffectKeys *>
    effect_keys() const;

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
