// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/death.h>
#include <morula/effects/forces/type_tension.h>
#include <morula/effects/growth/rate_growth.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/effects/state/neighbour_columns.h>
#include <morula/scene/idle_effects.h>
#include <morula/scene/tensions.h>

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Keys that something reads only in some scenes. */
    struct Reading
    {
      std::vector<std::string>           paths;
      std::function<bool(const Scene &)> is_read;
      std::string                        why; // nothing reads them
      std::string                        remedy;
    };

    bool
    has_tension(const Scene &scene)
    {
      for (const auto &row : tensions_of(scene).between)
        for (const double gamma : row)
          if (gamma != 0.)
            return true;
      return false;
    }

    bool
    rearranges(const Scene &scene)
    {
      return scene.keys<RearrangementParameters>().is_on();
    }

    bool
    has_transition(const Scene &scene)
    {
      for (const CellTypeKeys &type : scene.cell_types.types)
        for (const ExpressionKey &rate : type.transitions)
          if (!rate.is_default())
            return true;
      return false;
    }

    /** Whether some rate of growth can fall while a step lasts. */
    bool
    growth_reads_state(const Scene &scene)
    {
      const auto &keys  = scene.keys<RateGrowthParameters>();
      const auto  reads = [dim =
                            scene.dimension.value()](const ExpressionKey &key) {
        return key.differs_by_type() || key.expression(dim).depends_on_state();
      };
      return reads(keys.rate) || !keys.homeostasis.is_default() ||
             keys.homeostasis.differs_by_type();
    }

    const std::vector<Reading> readings = {
      {{"Neighbours/Found by", "Neighbours/Reach"},
       [](const Scene &scene) {
         return scene.keys<NeighbourParameters>().is_on();
       },
       "no expression asks for neighbours",
       "Use a variable of neighbours (doc/glossary.md), or remove this key."},
      {{"Tension/Force"},
       [](const Scene &scene) {
         return has_tension(scene) && rearranges(scene);
       },
       "no cells that change places have tensions",
       "Set Cell types/NAME/Tension and Rearrangement/Diffusion, or remove "
       "this key."},
      {{"Rearrangement/Fluctuation energy"},
       [](const Scene &scene) {
         return has_tension(scene) ||
                !scene.keys<RearrangementParameters>().drive.is_default() ||
                scene.keys<RearrangementParameters>().drive.differs_by_type();
       },
       "no exchange changes an energy: there is neither a tension nor a Drive",
       "Set Cell types/NAME/Tension, or remove this key."},
      {{"Contact/Fields pass"},
       [](const Scene &scene) { return scene.fields.present(); },
       "there are no fields",
       "Set Fields/Names, or remove this key."},
      {{"Material/On transition"},
       has_transition,
       "no cell changes its type",
       "Set Cell types/NAME/Transitions, or remove this key."},
      {{"Death/Final volume"},
       [](const Scene &scene) {
         const auto &time = scene.keys<DeathParameters>().shrinking_time;
         return time.differs_by_type() ||
                !time.expression(scene.dimension).is_always(0.);
       },
       "dead cells are removed at once, as Death/Shrinking time = 0",
       "Set a Shrinking time > 0, or remove this key."},
      {{"Growth/Rate/Predictor"},
       growth_reads_state,
       "no rate of growth depends on the cell's state",
       "Remove this key."},
      {{"Proliferation/Cell cycle/Axis spread"},
       [](const Scene &scene) {
         return scene.division_axes() != std::set<std::string>{"random"};
       },
       "all axes are random",
       "Set Proliferation/Cell cycle/Division axis, or remove this key."},
      {{"Proliferation/Cell cycle/Least anisotropy"},
       [](const Scene &scene) {
         const auto axes = scene.division_axes();
         return axes.count("stretch") + axes.count("stress") > 0;
       },
       "no axis is that of stretch or stress",
       "Set Proliferation/Cell cycle/Division axis, or remove this key."},
      {{"Solver/Largest gap"},
       [](const Scene &scene) {
         return std::any_of(scene.catalogue.boundary_conditions.begin(),
                            scene.catalogue.boundary_conditions.end(),
                            [](const auto &choice) {
                              return (choice.name() == "fixed" ||
                                      choice.name() == "slip") &&
                                     choice.keys().is_on();
                            });
       },
       "no boundary point is fixed or slips",
       "Remove this key."},
      {{"Output/Snapshot interval"},
       [](const Scene &scene) {
         return scene.output.snapshot_interval <= scene.time.end_time;
       },
       "the run ends before",
       "Lower it, or remove it."}};

    /** Whether the scene itself gives a key a value that is not the default. */
    bool
    is_given(const AnyKey &key, const Review &review)
    {
      return review.has_set(key) && !key.is_default();
    }

    /** A key and types' own ones of it, as far as the scene gives values. */
    std::vector<const AnyKey *>
    given(const Scene &scene, const AnyKey &key, const Review &review)
    {
      std::vector<const AnyKey *> list;
      if (is_given(key, review))
        list.push_back(&key);
      for (const CellTypeKeys &type : scene.cell_types.types)
        for (const ExpressionKey &own : type.overrides)
          if (!own.empty() && own.path() == type.path_of(key))
            list.push_back(&own);
      return list;
    }

    void
    warn_of_idle(const AnyKey      &key,
                 const std::string &why,
                 const std::string &remedy,
                 Review            &review)
    {
      review.warn(key.path(),
                  key.text(),
                  "it does nothing here: " + why + '.',
                  remedy);
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
        warn_of_idle(*first,
                     switch_key.path() + " = " + switch_key.text() + more,
                     "If that is meant, all is well.",
                     review);
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

    /** Warns of those effects of a kind whose keys have switched them off. */
    template <template <int> class Interface>
    void
    review_off(const Scene              &scene,
               const Choices<Interface> &choices,
               Review                   &review)
    {
      for (const auto &choice : choices)
        if (const AnyKey *const key = choice.keys().switch_key();
            key != nullptr && !choice.keys().is_on())
          review_switched_off(scene, choice.keys(), *key, review);
    }

    /** Warns of keys of a field that its kind does not have. */
    void
    review_field(const FieldKeys &field, Review &review)
    {
      if (field.is_steady() && is_given(field.dilution, review))
        warn_of_idle(field.dilution,
                     "a steady field is not diluted",
                     "Set " + field.time.path() +
                       " = transient, or remove this key.",
                     review);
    }
  } // namespace


  void
  review_idle_effects(const Scene &scene, Review &review)
  {
    // Effects that were switched off come first, then keys that only some
    // scenes read: those that the scene itself sets are said.
    review_not_named(scene,
                     scene.catalogue.growth_laws,
                     scene.growth_law,
                     {scene.law_of_growth()},
                     review);
    if (scene.has_proliferation() || scene.divides_by_fate())
      review_not_named(scene,
                       scene.catalogue.division_rules,
                       scene.cell_cycle.division_axis,
                       scene.division_axes(),
                       review);
    else
      review_switched_off(scene,
                          scene.cell_cycle,
                          scene.proliferation_law,
                          review);
    review_off(scene, scene.catalogue.growth_factors, review);
    review_off(scene, scene.catalogue.flows, review);
    review_off(scene, scene.catalogue.fates, review);
    review_off(scene, scene.catalogue.traits, review);
    review_off(scene, scene.catalogue.step_effects, review);
    review_off(scene, scene.catalogue.forces, review);
    review_off(scene, scene.catalogue.boundary_conditions, review);
    const auto list = scene.list();
    for (const Reading &reading : readings)
      for (const AnyKey *key : list)
        if (std::count(reading.paths.begin(),
                       reading.paths.end(),
                       key->path()) > 0 &&
            !reading.is_read(scene))
          for (const AnyKey *one : given(scene, *key, review))
            warn_of_idle(*one, reading.why, reading.remedy, review);
    for (const FieldKeys &field : scene.fields.fields)
      review_field(field, review);
  }
} // namespace Morula
