// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/review.h>
#include <morula/effects/growth/relaxation.h>
#include <morula/scene/applied.h>

#include <algorithm>
#include <optional>

// This file warns of what is unwise in what a scene applies, and of numbers
// that look like those of another unit. Nothing here is refused.

namespace Morula
{
  namespace
  {
    /** With fewer patches a condition's area is not known to a tenth. */
    constexpr std::uint64_t fewest_points = 10;

    /** A larger part of the loads than this is not left over by rounding and
     * the patches of a curved surface. */
    constexpr double largest_rest = 0.01;

    /** Loads without a resultant, as surface tension and the pressure of a
     *  lumen, have one of rounding: less than this stress on their area, kPa.
     */
    constexpr double rounding_stress = 1e-9;

    /** Young's moduli of soft tissue, kPa: brain has some tenths, cartilage
     *  some hundreds. */
    constexpr double softest = 0.005, stiffest = 500.;

    /** Cell cycles and relaxation times are shorter than this, day. */
    constexpr double longest_cycle = 10., longest_relaxation = 2.;

    /** Lengths of cells, µm. */
    constexpr double shortest_cell = 0.5, longest_cell = 300.;

    void
    review_number(const ExpressionKey &key,
                  const double         lower,
                  const double         upper,
                  const std::string   &unit,
                  const std::string   &usual,
                  const std::string   &question,
                  Review              &review)
    {
      // A key may have one number or one for each type; the largest is looked
      // at. A zero switches something off and is no number of another unit.
      const std::optional<double> number = key.largest_number(3);
      if (number && *number > 0. && (*number < lower || *number > upper))
        review.warn(key.path(),
                    as_text(*number) + ' ' + unit,
                    usual + ". " + question,
                    "If it is meant so, all is well.");
    }

    void
    review_points(const Scene                         &scene,
                  const std::vector<AppliedCondition> &applied,
                  Review                              &review)
    {
      // The key that says where the condition acts is named in the warning, so
      // conditions without such a key are passed over.
      for (const AppliedCondition &one : applied)
        if (one.points > 0 && one.points < fewest_points)
          for (const auto &choice : scene.catalogue.boundary_conditions)
            if (const AnyKey *const where = choice.keys().switch_key();
                where != nullptr && choice.name() == one.name)
              review.warn(where->path(),
                          where->text(),
                          "it acts on " + std::to_string(one.points) +
                            " boundary points, whose area is " +
                            as_text(one.area) +
                            (scene.dimension == 3 ? " um^2" : " um") +
                            ": with so few, what it covers jumps by a whole "
                            "patch, and so does its force.",
                          "Choose a larger place, or a smaller Tissue/Cell "
                          "spacing.");
    }

    /** Whether something but inertia can balance loads. */
    bool
    is_held(const Scene &scene, const std::vector<AppliedCondition> &applied)
    {
      for (const AppliedCondition &one : applied)
        if ((one.name == "fixed" || one.name == "slip") && one.points > 0)
          return true;
      for (const auto &choice : scene.catalogue.forces)
        if (choice.keys().is_on())
          return true; // friction, or a load that is not known here
      for (const auto &choice : scene.catalogue.boundary_conditions)
        if (choice.keys().is_on() && choice.keys().names_key() != nullptr)
          return true; // obstacles
      return false;
    }

    void
    review_balance(const Scene                         &scene,
                   const std::vector<AppliedCondition> &applied,
                   Review                              &review)
    {
      // All forces that are known before the run are added up. If a part is
      // left and nothing holds the tissue, doc/theory.md section 4.4 takes out
      // the rigid motion, which the user may not expect.
      if (is_held(scene, applied))
        return;
      Tensor<1, 3> sum;
      double       magnitude = 0., area = 0.;
      for (const AppliedCondition &one : applied)
        {
          sum += one.force;
          magnitude += one.magnitude;
          area += one.area;
        }
      if (!(sum.norm() >
            std::max(largest_rest * magnitude, rounding_stress * area)))
        return;
      std::string text;
      for (unsigned int d = 0; d < scene.dimension; ++d)
        text += (d == 0 ? "" : " ") + as_text(sum[d]);
      review.warn("Boundary conditions",
                  "nothing held",
                  "the loads add up to a force of (" + text + ") kPa um" +
                    (scene.dimension == 3 ? "^2" : "") +
                    " at the end, and nothing holds the tissue: inertia "
                    "balances them, as in free fall (doc/theory.md, section "
                    "4.4).",
                  "Hold a part of the surface by Fixed where or Slip where, "
                  "or balance the loads.");
    }
  } // namespace


  void
  review_applied(const Scene                         &scene,
                 const std::vector<AppliedCondition> &applied,
                 std::vector<std::string>            &warnings)
  {
    // Conditions come first, then the numbers of material, time and length. The
    // limits are wide: they are meant to catch a factor of 24 or 1000, not
    // unusual tissue.
    Review review{[&scene](const AnyKey &key) { return scene.has_set(key); }};
    review_points(scene, applied, review);
    review_balance(scene, applied, review);
    const std::string in_hours = "Is it in hours?";
    review_number(scene.material.youngs_modulus,
                  softest,
                  stiffest,
                  "kPa",
                  "soft tissue has 0.1 to 100 kPa",
                  "Is it in Pa or MPa?",
                  review);
    review_number(scene.keys<RelaxationParameters>().time,
                  0.,
                  longest_relaxation,
                  "day",
                  "tissue relaxes within minutes to hours",
                  in_hours,
                  review);
    if (scene.has_proliferation())
      review_number(scene.cell_cycle.duration,
                    0.,
                    longest_cycle,
                    "day",
                    "cell cycles take 0.3 to 3 days",
                    in_hours,
                    review);
    const double length = scene.tissue.cell_spacing;
    if (length < shortest_cell || length > longest_cell)
      review.warn(scene.tissue.cell_spacing.path(),
                  as_text(length) + " um",
                  "cells are 5 to 50 um long. Is it in another unit than um?",
                  "If it is meant so, all is well.");
    warnings.insert(warnings.end(),
                    review.warnings.begin(),
                    review.warnings.end());
  }
} // namespace Morula
