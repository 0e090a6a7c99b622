// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/name_list.h>
#include <morula/mechanics/materials/material.h>
#include <morula/output/point_fields.h>
#include <morula/scene/checks.h>
#include <morula/scene/scene.h>
#include <morula/scene/tissue_model.h>
#include <morula/seeding/seeding.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    void
    refuse_far_away(const Key<std::vector<double>> &place, const double h)
    {
      // Far from the origin, places have too few digits within a grid cell. The
      // negated comparison refuses NaN as well.
      for (const double x : place.value())
        if (!(std::abs(x) <= farthest_place * h))
          place.refuse("at most " + as_text(farthest_place) +
                         " grid spacings from the origin, " +
                         as_text(farthest_place * h) + " um",
                       "Move the scene nearer to the origin.");
    }

    void
    check_grid(const GridParameters &grid, const unsigned int dim)
    {
      grid.check_each(dim);
      refuse_far_away(grid.offset, grid.spacing);
      if (grid.offset->size() < dim)
        grid.offset.refuse(std::to_string(dim) + " numbers in um",
                           "Write one for each direction.");
    }

    void
    check_kernel(const Key<std::string>   &kernel,
                 const MaterialParameters &material)
    {
      // The kernels that can run depend on the processor, so the list of words
      // is made here.
      std::string runnable = "automatic, plain";
      bool        known    = kernel == "automatic" || kernel == "plain";
      for (const auto &kernels :
           material.chosen_material()->vector_kernels<3>())
        {
          runnable += std::string(", ") + kernels.name;
          known = known || kernel == kernels.name;
        }
      if (!known)
        kernel.refuse("on this processor one of " + runnable,
                      "'automatic' takes the fastest.");
    }

    /** Lets the keys of an effect refuse what contradicts them. */
    void
    check_with(const Scene &scene, const EffectKeys &keys)
    {
      // Warnings come later, when the scene has passed all checks.
      Review none;
      keys.check(scene, none);
    }

    /**
     * Refuses values that do nothing because what they belong to is off, those
     * of types as well. If the user wrote the switch, it was switched off on
     * purpose.
     */
    void
    refuse_forgotten(const Scene       &scene,
                     const AnyKey      &switch_key,
                     const Keys        &keys,
                     const std::string &remedy)
    {
      if (scene.has_set(switch_key))
        return;
      const std::string why   = switch_key.path() + " is not set";
      const std::string to_do = remedy + ", or remove this key.";
      for (const AnyKey *key : keys.list())
        {
          if (key == &switch_key)
            continue;
          if (!key->is_default())
            key->refuse("its default, as " + why, to_do);
          for (const ExpressionKey *own : scene.cell_types.own_values_of(*key))
            own->refuse("nothing, as " + why, to_do);
        }
    }

    /** Checks an effect's keys and makes it, for what it refuses. */
    template <int dim, template <int> class Interface>
    void
    try_effect(const Scene &scene, const Choice<Interface> &choice)
    {
      // An effect is made with columns of its own, which are thrown away.
      // Growth is needed in them, since effects may ask for its column.
      choice.keys().check_each(dim);
      CellColumns<dim>  columns;
      StateColumns<dim> state = state_columns_of<dim>(scene);
      columns.need_growth();
      choice.template make<dim>(effect_setting(scene, columns, state));
    }

    /** Checks the effects that the scene names and makes them, for what they
     *  refuse; refuses values of those that it does not name. */
    template <int dim, template <int> class Interface>
    void
    check_named(const Scene                 &scene,
                const Choices<Interface>    &choices,
                const AnyKey                &switch_key,
                const std::set<std::string> &chosen)
    {
      for (const auto &choice : choices)
        if (chosen.count(choice.name()) > 0)
          try_effect<dim>(scene, choice);
        else
          refuse_forgotten(scene,
                           switch_key,
                           choice.keys(),
                           "Set " + switch_key.path() + " = " + choice.name());
    }

    /** Checks the effects that their keys switch on and makes them, for what
     * they refuse; refuses values of those that are off. */
    template <int dim, template <int> class Interface>
    void
    check_switched(const Scene &scene, const Choices<Interface> &choices)
    {
      // What keys contradict is said before an effect that is on is made. One
      // that is off must not have values that do nothing: first each is checked
      // for itself, so that a mistake in it is reported as what it is. Both are
      // checked with the rest of the scene.
      for (const auto &choice : choices)
        {
          const EffectKeys   &keys       = choice.keys();
          const AnyKey *const switch_key = keys.facts().switch_key;
          for (const AnyKey *key : keys.list())
            if (keys.is_on() || !key->is_default())
              key->check(dim);
          check_with(scene, keys);
          if (keys.is_on())
            try_effect<dim>(scene, choice);
          if (!keys.is_on() && switch_key != nullptr)
            refuse_forgotten(scene,
                             *switch_key,
                             keys,
                             "Set " + switch_key->path());
        }
    }

    /** Refuses a second way of dividing: the lineage of a scene has one clock
     *  or none. */
    void
    check_one_way_to_divide(const Scene &scene)
    {
      const Choice<Fate> *first = nullptr;
      for (const auto &choice : scene.catalogue.fates)
        {
          const EffectFacts   facts = choice.keys().facts();
          const AnyKey *const key   = facts.switch_key;
          if (!choice.keys().is_on() || !facts.divides_cells || key == nullptr)
            continue;
          if (first != nullptr)
            key->refuse("its default, as cells divide by the " + first->name(),
                        "Remove this key, or " +
                          first->keys().facts().switch_key->path() +
                          ", also in the sections of types.");
          first = &choice;
        }
    }

    template <int dim>
    void
    check_division(const Scene &scene)
    {
      // Without division all its keys have to be at their defaults, those of
      // rules and of types, too. With it, keys that shape an axis are refused
      // where the axis is that by chance; then the rules are made, for what
      // they refuse.
      const DivisionParameters &division = scene.division;
      const EffectKeys *const   way      = scene.first_way_to_divide();
      check_one_way_to_divide(scene);
      if (!scene.cells_divide() && way != nullptr)
        {
          const AnyKey     &switch_key = *way->facts().switch_key;
          const std::string remedy     = "Set " + switch_key.path();
          refuse_forgotten(scene, switch_key, division, remedy);
          check_named<dim>(scene,
                           scene.catalogue.division_rules,
                           division.axis,
                           {});
          for (const CellTypeKeys &type : scene.cell_types.types)
            if (!type.division_axis->empty())
              type.division_axis.refuse("nothing, as no cell proliferates",
                                        remedy + ", or remove this key.");
          return;
        }
      division.check_each(dim);
      for (const ExpressionKey *shaping :
           {&division.axis_spread, &division.least_anisotropy})
        if (!shaping->is_default() &&
            scene.division_axes() == std::set<std::string>{"random"} &&
            !scene.has_set(division.axis))
          shaping->refuse("its default, as " + division.axis.path() +
                            " is not set",
                          "Say by " + division.axis.path() +
                            " along what cells divide, or remove this key.");
      check_named<dim>(scene,
                       scene.catalogue.division_rules,
                       division.axis,
                       scene.division_axes());
    }

    /** Refuses names of the scene's own that other columns of cells have. */
    template <int dim>
    void
    check_columns(const Scene &scene)
    {
      // The table of all columns refuses two that are equal. Its message has
      // the name, which tells whose it is.
      for (const EffectKeys *const keys : scene.catalogue.all_keys())
        if (const AnyKey *const names = keys->facts().names_key;
            names != nullptr && keys->is_on())
          try
            {
              CellFields<dim>(0., 0, effects_of<dim>(scene).columns, true);
            }
          catch (const std::invalid_argument &error)
            {
              const std::string message = error.what();
              for (const std::string &name : split_names(names->text()))
                if (message.find("'" + name + "'") != std::string::npos)
                  names->refuse("names that no other column of cells-NNNN.csv "
                                "and snapshot.h5 has",
                                message + " Choose another name.");
            }
    }


    /** Refuses a second interaction: a point has one force from each body. */
    void
    check_one_interaction(const Scene &scene)
    {
      const Choice<Interaction> *first = nullptr;
      for (const auto &choice : scene.catalogue.interactions)
        {
          if (!choice.keys().is_on())
            continue;
          if (first != nullptr)
            choice.keys().list().front()->refuse("such that there is no " +
                                                   choice.name() +
                                                   ", as bodies have " +
                                                   first->name() + " already",
                                                 "Do without one of the two.");
          first = &choice;
        }
    }


    template <int dim>
    void
    check_boundary_conditions(const Scene &scene)
    {
      // Cells from a file may have no surface. Then each condition would act
      // nowhere, which is refused before conditions are made.
      for (const auto &choice : scene.catalogue.boundary_conditions)
        if (choice.keys().is_on() && scene.tissue.has_no_surface())
          {
            choice.keys().check_each(dim);
            const AnyKey *const key = choice.keys().facts().switch_key;
            (key != nullptr ? key : choice.keys().list().front())
              ->refuse("nothing, as " + scene.tissue.points_surface.path() +
                         " = none",
                       "Remove the condition, or set Points surface = "
                       "automatic.");
          }
      check_switched<dim>(scene, scene.catalogue.boundary_conditions);
      scene.nitsche.check_each(dim);
    }

    template <int dim>
    void
    check_scene(const Scene &scene)
    {
      // The order is that in which a mistake is easiest to understand: time,
      // space and material, then cells and what they do, then what acts on
      // them. Types of cells come before effects, which are made with them.
      scene.time.check();
      check_grid(scene.grid, dim);
      // Points have volumes of their own, which are tested as they are read.
      if (const double longest = longest_cell * scene.grid.spacing;
          !scene.tissue.is_points() && scene.tissue.cell_spacing > longest)
        scene.tissue.cell_spacing.refuse(
          "a spacing of at most " + as_text(longest_cell) +
            " times Grid/Spacing, " + as_text(longest) + " um",
          "Choose a smaller spacing, or a larger Grid/Spacing: a "
          "cell deforms as a whole.");
      scene.tissue.check(dim);
      refuse_far_away(scene.tissue.center, scene.grid.spacing);
      scene.material.check_each(dim);
      check_with(scene, scene.cell_types);
      check_named<dim>(scene,
                       scene.catalogue.growth_laws,
                       scene.growth_law,
                       {scene.law_of_growth()});
      check_division<dim>(scene);
      check_switched<dim>(scene, scene.catalogue.growth_factors);
      check_switched<dim>(scene, scene.catalogue.flows);
      check_switched<dim>(scene, scene.catalogue.fates);
      check_switched<dim>(scene, scene.catalogue.equations);
      check_switched<dim>(scene, scene.catalogue.traits);
      check_columns<dim>(scene);
      check_switched<dim>(scene, scene.catalogue.step_effects);
      check_boundary_conditions<dim>(scene);
      check_switched<dim>(scene, scene.catalogue.forces);
      check_switched<dim>(scene, scene.catalogue.interactions);
      check_one_interaction(scene);
      scene.solver.check_each(dim);
      check_kernel(scene.solver.kernel, scene.material);
      scene.output.check_each(dim);
    }
  } // namespace


  void
  Scene::check() const
  {
    if (dimension == 2)
      check_scene<2>(*this);
    else if (dimension == 3)
      check_scene<3>(*this);
    else
      dimension.refuse("2 or 3", "Choose one of them.");
  }


  namespace
  {
    /** Warns of a key that does nothing, if the scene gives it a value for all
     *  cells or for those of a type. @param why half a sentence */
    void
    warn_of_idle(const Scene       &scene,
                 const AnyKey      &key,
                 const std::string &why,
                 const std::string &remedy,
                 Review            &review)
    {
      const auto warn = [&](const AnyKey &value) {
        review.warn(value.path(),
                    value.text(),
                    "it does nothing " + why + '.',
                    remedy);
      };
      if (scene.has_set(key) && !key.is_default())
        warn(key);
      for (const ExpressionKey *own : scene.cell_types.own_values_of(key))
        warn(*own);
    }

    /** Warns of the keys of laws, or of rules, that the scene does not choose.
     *  Where it sets the switch to its default, it has switched them off on
     *  purpose; where it does not set it, they have been refused. */
    template <template <int> class Interface>
    void
    review_not_chosen(const Scene                 &scene,
                      const Choices<Interface>    &choices,
                      const AnyKey                &switch_key,
                      const std::set<std::string> &chosen,
                      Review                      &review)
    {
      if (!scene.has_set(switch_key) || switch_key.is_default())
        return;
      const std::string choose = switch_key.path() + " = ";
      for (const auto &choice : choices)
        if (chosen.count(choice.name()) == 0)
          for (const AnyKey *const key : choice.keys().list())
            warn_of_idle(scene,
                         *key,
                         "with " + choose + switch_key.text(),
                         "Remove it, or set " + choose + choice.name() + '.',
                         review);
    }
  } // namespace


  void
  review_idle_keys(const Scene &scene, Review &review)
  {
    review_not_chosen(scene,
                      scene.catalogue.growth_laws,
                      scene.growth_law,
                      {scene.law_of_growth()},
                      review);
    review_not_chosen(scene,
                      scene.catalogue.division_rules,
                      scene.division.axis,
                      scene.division_axes(),
                      review);
    std::map<std::string, const AnyKey *> keys;
    for (const AnyKey *const key : scene.list())
      keys[key->path()] = key;
    // What a key needs is a path, or a path and a value.
    const auto is_met = [&keys](const std::string &text) {
      const auto equals = text.find('=');
      const auto other  = keys.find(text.substr(0, equals));
      return other != keys.end() &&
             (equals == std::string::npos ?
                other->second->is_changed() :
                other->second->text() == text.substr(equals + 1));
    };
    for (const AnyKey *const key : scene.list())
      for (const std::vector<std::string> &needed : key->needed())
        if (std::none_of(needed.begin(), needed.end(), is_met))
          {
            const std::string any = boost::join(needed, " or ");
            warn_of_idle(scene,
                         *key,
                         "without " + any,
                         "Set " + any + ", or remove this key.",
                         review);
            break;
          }
  }
} // namespace Morula
