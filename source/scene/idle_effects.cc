// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/scene/reviews.h>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The value of a key that is to be warned of, if it does nothing: the
     *  scene's for all cells, and those of types. */
    std::vector<const AnyKey *>
    given(const Scene &scene, const AnyKey &key, const Review &review)
    {
      std::vector<const AnyKey *> list;
      if (review.is_given(key))
        list.push_back(&key);
      for (const ExpressionKey *own : scene.cell_types.own_values_of(key))
        list.push_back(own);
      return list;
    }

    /** Warns of an effect that was switched off, though it has values. */
    void
    review_switched_off(const Scene  &scene,
                        const Keys   &keys,
                        const AnyKey &switch_key,
                        Review       &review)
    {
      // One line for each effect is enough, types' own values and all. A switch
      // that the scene does not set is refused elsewhere, as forgotten.
      if (!review.has_set(switch_key))
        return;
      std::string   more;
      const AnyKey *first = nullptr;
      for (const AnyKey *key : keys.list())
        if (key != &switch_key)
          for (const AnyKey *one : given(scene, *key, review))
            {
              if (first == nullptr)
                first = one;
              else
                more += (more.empty() ? "; so do " : ", ") + one->path();
            }
      if (first != nullptr)
        review.warn_of_idle(*first,
                            switch_key.path() + " = " + switch_key.text() +
                              more,
                            "If that is meant, all is well.");
    }

    /** Warns of those effects of a kind that the scene does not name. */
    template <template <int> class Interface>
    void
    review_not_named(const Scene                 &scene,
                     const Choices<Interface>    &choices,
                     const AnyKey                &switch_key,
                     const std::set<std::string> &chosen,
                     Review                      &review)
    {
      for (const auto &choice : choices)
        if (chosen.count(choice.name()) == 0)
          review_switched_off(scene, choice.keys(), switch_key, review);
    }

    /** Warns of keys that need another one, which has its default. */
    void
    review_needs(const Scene &scene, Review &review)
    {
      std::map<std::string, const AnyKey *> keys;
      for (const AnyKey *const key : scene.list())
        keys[key->path()] = key;
      for (const AnyKey *const key : scene.list())
        for (const std::vector<std::string> &paths : key->needed())
          {
            std::string missing;
            bool        is_met = false;
            for (const std::string &path : paths)
              {
                const auto other = keys.find(path);
                is_met           = is_met ||
                         (other != keys.end() && other->second->is_changed());
                missing += (missing.empty() ? "" : " and ") + path;
              }
            const auto values = given(scene, *key, review);
            if (is_met || values.empty())
              continue;
            review.warn(values.front()->path(),
                        values.front()->text(),
                        "it does nothing without " + missing + '.',
                        "Set this key as well, or remove the other.");
            break;
          }
    }
  } // namespace


  void
  review_idle_effects(const Scene &scene, Review &review)
  {
    // Effects that were switched off come first, then keys that only some
    // scenes read: those that the scene itself sets are said, once each.
    review_not_named(scene,
                     scene.catalogue.growth_laws,
                     scene.growth_law,
                     {scene.law_of_growth()},
                     review);
    if (scene.cells_divide())
      review_not_named(scene,
                       scene.catalogue.division_rules,
                       scene.division.axis,
                       scene.division_axes(),
                       review);
    else if (const EffectKeys *const way = scene.first_way_to_divide())
      review_switched_off(scene,
                          scene.division,
                          *way->facts().switch_key,
                          review);
    for (const EffectKeys *const keys : scene.effect_keys())
      if (const AnyKey *const key = keys->facts().switch_key;
          key != nullptr && !keys->is_on())
        review_switched_off(scene, *keys, *key, review);
    review_needs(scene, review);
  }
} // namespace Morula
