// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/review.h>
#include <morula/scene/applied.h>

// This file warns of what is unwise in what a scene applies. Nothing here is
// refused.

namespace Morula
{
  namespace
  {
    /** With fewer patches a condition's area is not known to a tenth. */
    constexpr std::uint64_t fewest_points = 10;

    /** The other keys of a condition than that of its place. */
    std::string
    other_keys(const Scene            &scene,
               const AppliedCondition &one,
               const AnyKey           &where)
    {
      std::string paths;
      for (const AnyKey *key :
           find_choice(scene.catalogue.boundary_conditions, one.name)
             ->keys()
             .list())
        if (key != &where)
          paths += (paths.empty() ? "" : " or ") + key->path();
      return paths;
    }

    /** Loads that are none. */
    void
    review_load(const Scene            &scene,
                const AppliedCondition &one,
                const AnyKey           &where,
                Review                 &review)
    {
      const std::string keys = other_keys(scene, one, where);
      if (one.points == 0 && one.chosen > 0)
        review.warn(where.path(),
                    where.text(),
                    "it acts nowhere: at all " + std::to_string(one.chosen) +
                      " boundary points that it chooses another condition wins "
                      "(fixed over slip, slip over loads).",
                    "Choose places that differ.");
      else if (one.is_idle && !keys.empty() && !one.is_tension)
        review.warn(where.path(),
                    where.text(),
                    "its load is zero at the end of every step.",
                    "Set " + keys + ", or remove the condition.");
    }

    void
    review_points(const Scene            &scene,
                  const AppliedCondition &one,
                  const AnyKey           &where,
                  Review                 &review)
    {
      if (one.points > 0 && one.points < fewest_points)
        review.warn(where.path(),
                    where.text(),
                    "it acts on " + std::to_string(one.points) +
                      " boundary points, whose area is " + as_text(one.area) +
                      (scene.dimension == 3 ? " um^2" : " um") +
                      ": with so few, what it covers jumps by a whole patch, "
                      "and so does its force.",
                    "Choose a larger place, or a smaller Tissue/Cell spacing.");
    }

    /** Calls @p action for each condition and the key that says where it acts,
     *  which warnings name; conditions without one are passed over. */
    template <typename Action>
    void
    for_placed(const Scene                         &scene,
               const std::vector<AppliedCondition> &applied,
               const Action                        &action)
    {
      for (const AppliedCondition &one : applied)
        if (const auto *const choice =
              find_choice(scene.catalogue.boundary_conditions, one.name))
          if (const AnyKey *const where = choice->keys().facts().switch_key)
            action(one, *where);
    }
  } // namespace


  void
  review_applied(const Scene                         &scene,
                 const std::vector<AppliedCondition> &applied,
                 std::vector<std::string>            &warnings)
  {
    Review review{[&scene](const AnyKey &key) { return scene.has_set(key); }};
    for_placed(scene, applied, [&](const auto &one, const AnyKey &where) {
      review_points(scene, one, where, review);
    });
    for_placed(scene, applied, [&](const auto &one, const AnyKey &where) {
      review_load(scene, one, where, review);
    });
    warnings.insert(warnings.end(),
                    review.warnings.begin(),
                    review.warnings.end());
  }
} // namespace Morula
