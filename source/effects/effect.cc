// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/effect.h>
#include <morula/effects/scene_keys.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <exception>

// What an effect does by default, and the search for values that never act.

namespace Morula
{
  std::string
  EffectKeys::details() const
  {
    // The list begins with a comma since the name of the effect stands before
    // it. Defaults that switch something off or on are left out, unless there
    // is nothing else.
    const auto list = this->list();
    const bool all =
      std::all_of(list.begin(), list.end(), [](const AnyKey *key) {
        return key->is_default();
      });
    std::string text;
    for (const AnyKey *key : list)
      if (const std::string value = key->text();
          !value.empty() &&
          (all || !key->is_default() || (value != "0" && value != "true")))
        text += ", " + key->short_name() + " = " + value;
    return text;
  }


  namespace
  {
    /** So many evaluations take a fraction of a second. */
    constexpr double most_asked = 1e6;

    /** Whether only place, time and the type's own text decide. */
    bool
    is_of_place_and_time(const Expression &value)
    {
      for (const Variable variable : value.used())
        if (variable > Variable::t && variable != Variable::type)
          return false;
      // The type is a variable also where types have texts of their own.
      return !value.uses(Variable::type) ||
             (!value.types().empty() &&
              value.text().find("type") == std::string::npos);
    }
  } // namespace


  template <int dim>
  bool
  never_acts(const Expression                        &value,
             const std::function<bool(const double)> &acts,
             const AskedAt                            moments,
             const Preview<dim>                      &scene)
  {
    // A value without time is asked for once at each founder, others at all
    // moments of the run, as far as that is quick. The first one that acts ends
    // the search: few are asked for but where nothing happens.
    const double n_steps =
      std::ceil(scene.keys.time.end_time / scene.keys.time.step - 1e-9);
    const bool of_time = value.depends_on_time();
    if (!is_of_place_and_time(value) ||
        (of_time &&
         n_steps * std::max<double>(1, scene.n_founders) > most_asked))
      return false;
    std::vector<double> times = {0.};
    for (double i = 0.; of_time && i < n_steps; ++i)
      {
        if (moments == AskedAt::all_moments)
          times.push_back(std::min((i + 0.5) * scene.keys.time.step,
                                   scene.keys.time.end_time.value()));
        times.push_back(std::min((i + 1.) * scene.keys.time.step,
                                 scene.keys.time.end_time.value()));
      }
    std::vector<const Expression *> of_types = {&value};
    for (const auto &[type, own] : value.types())
      of_types.push_back(&own);
    bool found = false;
    try
      {
        for (const double t : times)
          for (const Point<dim> &X : scene.founders)
            for (const Expression *one : of_types)
              if (!found)
                found = acts(one->value(X, t));
      }
    catch (const std::exception &)
      {
        found = true;
      }
    return Utilities::MPI::max(found ? 1 : 0, scene.comm) == 0;
  }


  template <int dim>
  void
  review_rate(const Expression   &rate,
              const std::string  &so,
              const Preview<dim> &scene,
              Review             &review)
  {
    if (!rate.is_always(0.) && never_acts<dim>(
                                 rate,
                                 [](const double r) { return r != 0.; },
                                 AskedAt::all_moments,
                                 scene))
      review.warn(rate.key(),
                  rate.text(),
                  "it is 0 at all founders in all steps: " + so,
                  "Correct it, or remove it.");
  }


  template <int dim>
  void
  review_growth(const std::vector<const Expression *> &values,
                const double                           neutral,
                const Preview<dim>                    &scene,
                Review                                &review)
  {
    // The search is collective, so all ranks go through all values.
    bool grows = false;
    for (const Expression *const value : values)
      grows = !never_acts<dim>(
                *value,
                [neutral](const double x) { return x != neutral; },
                AskedAt::all_moments,
                scene) ||
              grows;
    if (!grows)
      review.warn(values.front()->key(),
                  values.front()->text(),
                  std::string("no cell grows: it is ") +
                    (neutral == 0. ? "0" : "1") +
                    " at all founders in all steps.",
                  "Set the keys of its section, or remove the law.");
  }


  MORULA_INSTANTIATE(never_acts);
  MORULA_INSTANTIATE(review_rate);
  MORULA_INSTANTIATE(review_growth);
} // namespace Morula
