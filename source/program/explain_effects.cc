// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/explain_parts.h>

#include <iomanip>

// The effects of a scene, a line each.

namespace Morula
{
  namespace
  {
    /** What a condition does at t = 0, a line for each of its parts. */
    std::string
    applied_lines(const Scene                         &scene,
                  const std::vector<AppliedCondition> &applied,
                  const std::string                   &name)
    {
      std::string lines;
      for (const AppliedCondition &one : applied)
        if (one.name == name)
          lines += "    " + text_of(scene, one) + '\n';
      return lines;
    }

    /** On which founders an effect acts, if it says so. */
    std::string
    of_founders(const types::particle_index n,
                const types::particle_index n_founders,
                const EffectKeys           &keys)
    {
      const ExpressionKey *const where = keys.founders_key();
      if (where == nullptr)
        return "";
      return n == n_founders ?
               ", all " + std::to_string(n) + " founders" :
               ", " + std::to_string(n) + " of " + std::to_string(n_founders) +
                 " founders, where " + where->text();
    }

    /** What the chosen effect's keys say, if it is one of the catalogue. */
    template <template <int> class Interface>
    std::string
    details_of(const Choices<Interface> &choices, const std::string &chosen)
    {
      const auto *choice = find_choice(choices, chosen);
      return choice == nullptr ? "" : choice->keys().details();
    }

    /** What a condition or force is called. */
    template <template <int> class Interface>
    std::string
    topic_of(const Choice<Interface> &choice)
    {
      const std::string topic = choice.keys().topic();
      return topic.empty() ? choice.name() : topic;
    }

    /** The row of an effect, if its keys switch it on.
     *  @param more behind its details */
    template <template <int> class Interface>
    void
    add_choice(EffectRows              &rows,
               const Choice<Interface> &choice,
               const RestOfScene       &scene,
               const std::string       &more = "")
    {
      // What has no keys is a part of others.
      const EffectKeys &keys = choice.keys();
      if (!keys.list().empty() && keys.is_on())
        add_effect(rows,
                   topic_of(choice),
                   keys.details() + more,
                   keys.further_lines(scene));
    }

    /** Rows for all effects of a kind. */
    template <template <int> class Interface>
    void
    add_effects(EffectRows               &rows,
                const Choices<Interface> &choices,
                const RestOfScene        &scene)
    {
      for (const auto &choice : choices)
        add_choice(rows, choice, scene);
    }
  } // namespace


  void
  add_effect(EffectRows        &rows,
             const std::string &name,
             const std::string &description,
             const std::string &further)
  {
    rows.push_back({name, description, further});
  }


  void
  print(std::ostream &out, const EffectRow &row)
  {
    out << "  " << std::left << std::setw(24) << row.name << row.description
        << '\n'
        << row.further;
  }


  EffectRows
  effect_rows(const Scene                         &scene,
              const ConditionCounts               &counts,
              const std::vector<AppliedCondition> &applied,
              const types::particle_index          n_founders,
              const types::particle_index          n_proliferating)
  {
    const Catalogue          &catalogue = scene.catalogue;
    const DivisionParameters &division  = scene.division;
    const RestOfScene         rest      = scene.rest_of_scene();

    // The rows come in a fixed order: first what the library does to cells,
    // then the effects of the catalogue in its order, then properties of the
    // material and of the surface. An effect that is off has no row.
    EffectRows out;
    if (scene.has_growth())
      add_effect(out,
                 "growth",
                 scene.law_of_growth() +
                   details_of(catalogue.growth_laws, scene.law_of_growth()));
    const auto add_fates = [&](const bool that_grow) {
      for (const auto &choice : catalogue.fates)
        if (choice.keys().grows_cells() == that_grow)
          add_choice(out,
                     choice,
                     rest,
                     of_founders(n_proliferating, n_founders, choice.keys()));
    };
    add_fates(true);
    if (scene.cells_divide())
      add_effect(out,
                 "division (Voronoi)",
                 "axis = " + scene.division_axis() +
                   details_of(catalogue.division_rules, scene.division_axis()) +
                   (division.axis_follows_rotation ? ", follows rotation" :
                                                     "") +
                   (division.stay_inside ? ", inside the surface" : ""));
    add_effects(out, catalogue.growth_factors, rest);
    add_fates(false);
    add_effects(out, catalogue.equations, rest);
    add_effects(out, catalogue.traits, rest);
    add_effects(out, catalogue.step_effects, rest);
    for (const auto &choice : catalogue.boundary_conditions)
      // A condition is on if it acts somewhere: its expression may be true at
      // no boundary point.
      if (const types::particle_index n = counts.acting.at(choice.name()))
        {
          const AnyKey *const where = choice.keys().switch_key();
          add_effect(out,
                     topic_of(choice),
                     "at " + std::to_string(n) + " boundary points" +
                       (where == nullptr ? "" : ", where " + where->text()) +
                       choice.keys().details(),
                     applied_lines(scene, applied, choice.name()));
        }
    add_effects(out, catalogue.forces, rest);
    add_effect(out, "material", material_text(scene));
    add_effects(out, catalogue.flows, rest);
    if (scene.tissue.refine_surface)
      add_effect(out,
                 "surface refinement",
                 "patches longer than " + as_text(0.5 * scene.grid.spacing) +
                   " um are split");
    if (scene.material.volumetric_form() != VolumetricStrain::pointwise)
      add_effect(out,
                 "volumetric strain",
                 scene.material.volumetric_strain.text() + " in a grid cell");
    return out;
  }
} // namespace Morula
