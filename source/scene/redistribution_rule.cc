// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/scene/tissue_model.h>

#include <algorithm>

// Where cells keep their places: Tissue/Redistribution.

namespace Morula
{
  namespace
  {
    /** Whether cells side by side may grow differently: by their types. Growth
     *  by place or by a field is alike among neighbours. */
    bool
    grow_unevenly(const Scene &scene)
    {
      for (unsigned int type = 1; type < scene.cell_types.types.size(); ++type)
        if (scene.grows(type) != scene.grows(0))
          return true;
      const auto differ = [](const EffectKeys &keys) {
        const auto list = keys.list();
        return std::any_of(list.begin(), list.end(), [](const AnyKey *key) {
          const auto *expression = dynamic_cast<const ExpressionKey *>(key);
          return expression != nullptr && expression->differs_by_type();
        });
      };
      const auto &law     = scene.catalogue.growth_laws;
      const auto &factors = scene.catalogue.growth_factors;
      return (scene.has_growth() &&
              differ(find_choice(law, scene.law_of_growth())->keys())) ||
             std::any_of(factors.begin(), factors.end(), [&](const auto &one) {
               return one.keys().is_on() && differ(one.keys());
             });
    }
  } // namespace


  Redistribution
  redistribution_of(const Scene &scene)
  {
    // Where cells neither divide nor flow nor grow differently their places fit
    // as they did at t = 0. Volumes of elastic tissue are what its motion has
    // made of them, and volumes of single cells have their own equilibrium.
    if (scene.tissue.redistribution == "false")
      return {};
    Redistribution result;
    bool           exchanges = false;
    for (const auto &choice : scene.catalogue.step_effects)
      {
        result.all_flows =
          result.all_flows || choice.keys().facts().releases_shear;
        exchanges = exchanges || choice.keys().facts().exchanges_places;
      }
    const bool flows = scene.flows() || result.all_flows;
    result.places    = scene.tissue.redistribution == "true" || exchanges ||
                    flows || scene.cells_divide() || scene.grows_by_fate() ||
                    grow_unevenly(scene);
    result.volumes =
      flows && scene.material.volumetric_form() != VolumetricStrain::pointwise;
    return result;
  }
} // namespace Morula
