// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/review.h>
#include <morula/effects/usual_numbers.h>
#include <morula/scene/applied.h>

#include <optional>
#include <utility>

// This file warns of what is unwise in what a scene applies, and of numbers
// that look like those of another unit. Nothing here is refused.

namespace Morula
{
  namespace
  {
    /** With fewer patches a condition's area is not known to a tenth. */
    constexpr std::uint64_t fewest_points = 10;

    /** Young's moduli of soft tissue, kPa: brain has some tenths, cartilage
     *  some hundreds. */
    constexpr double softest = 0.005, stiffest = 500.;

    /** A load per area below so many E does nothing to tissue. */
    constexpr double weakest_load = 1e-6;

    /** Lengths of cells, µm. */
    constexpr double shortest_cell = 0.5, longest_cell = 300.;

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

    /** Loads that are none, or far stronger than the tissue. */
    void
    review_load(const Scene                 &scene,
                const AppliedCondition      &one,
                const AnyKey                &where,
                const std::optional<double> &stiffness,
                Review                      &review)
    {
      // A condition has one warning at most, the surest first: it acts nowhere,
      // it is zero in all steps, it is far too strong, or far too weak. The
      // forces of a tension cancel on a closed surface, so that a small sum
      // says nothing of it.
      const auto warn = [&](const std::string &why, const std::string &remedy) {
        review.warn(where.path(), where.text(), why, remedy);
      };
      const std::string keys  = other_keys(scene, one, where);
      const double      scale = stiffness.value_or(0.) * one.area;
      if (one.points == 0 && one.chosen > 0)
        warn("it acts nowhere: at all " + std::to_string(one.chosen) +
               " boundary points that it chooses another condition wins (fixed "
               "over slip, slip over loads).",
             "Choose places that differ.");
      else if (one.is_idle && !keys.empty() && !one.is_tension)
        warn("its load is zero at the end of every step.",
             "Set " + keys + ", or remove the condition.");
      else if (stiffness && one.points > 0 &&
               one.magnitude > strongest_load * scale)
        warn("its load is " + as_text(one.magnitude / one.area) +
               " kPa on average, " +
               as_text(one.magnitude / one.area / *stiffness) +
               " times the stiffest cell's E. Is it in Pa?",
             "If it is meant so, all is well.");
      else if (stiffness && one.has_force && one.points > 0 &&
               one.magnitude > 0. && !one.is_tension &&
               one.magnitude < weakest_load * scale)
        warn("its load is " + as_text(one.magnitude / one.area) +
               " kPa on average, next to nothing beside the stiffest cell's E. "
               "Is it in MPa?",
             "If it is meant so, all is well.");
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
          if (const AnyKey *const where = choice->keys().switch_key())
            action(one, *where);
    }
  } // namespace


  template <int dim>
  void
  review_applied(const Scene                         &scene,
                 const std::vector<AppliedCondition> &applied,
                 const std::vector<Point<dim>>       &founders,
                 const MPI_Comm                       comm,
                 std::vector<std::string>            &warnings)
  {
    // Conditions come first, then the numbers of material and length. The
    // limits are wide: they are meant to catch a factor of 24 or 1000, not
    // unusual tissue.
    Review review{[&scene](const AnyKey &key) { return scene.has_set(key); }};
    const ExpressionKey        &E           = scene.material.youngs_modulus;
    const ValueRange            stiffnesses = range_of<dim>(E, founders, comm);
    const std::optional<double> stiffness =
      stiffnesses ? stiffnesses->second : std::optional<double>();
    for_placed(scene, applied, [&](const auto &one, const AnyKey &where) {
      review_points(scene, one, where, review);
    });
    for_placed(scene, applied, [&](const auto &one, const AnyKey &where) {
      review_load(scene, one, where, stiffness, review);
    });
    review_number(E,
                  stiffnesses,
                  softest,
                  stiffest,
                  "kPa",
                  "soft tissue has 0.1 to 100 kPa",
                  "Is it in Pa or MPa?",
                  review);
    const double length = scene.tissue.cell_spacing;
    if (!scene.tissue.is_points() &&
        (length < shortest_cell || length > longest_cell))
      review.warn(scene.tissue.cell_spacing.path(),
                  as_text(length) + " um",
                  "cells are 5 to 50 um long. Is it in another unit than um?",
                  "If it is meant so, all is well.");
    warnings.insert(warnings.end(),
                    review.warnings.begin(),
                    review.warnings.end());
  }


  MORULA_INSTANTIATE(review_applied);
} // namespace Morula
