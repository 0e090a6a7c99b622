// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/death.h>
#include <morula/effects/fate/extrusion.h>
#include <morula/effects/growth/contraction.h>
#include <morula/effects/growth/isotropic.h>
#include <morula/effects/growth/rate_growth.h>
#include <morula/effects/rearrangement/rearrangement.h>
#include <morula/scene/idle_rates.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Whether a key has another value than its default, for any type. */
    bool
    is_set(const ExpressionKey &key)
    {
      return !key.empty() && (!key.is_default() || key.differs_by_type());
    }

    /** Whether only place, time and the type's own text decide. */
    bool
    is_of_place_and_time(const ExpressionKey &key, const unsigned int dim)
    {
      const Expression &expression = key.expression(dim);
      for (const Variable variable : expression.used())
        if (variable > Variable::t && variable != Variable::type)
          return false;
      // The type is a variable also where types have texts of their own.
      return !expression.uses(Variable::type) ||
             (!expression.types().empty() &&
              key.text().find("type") == std::string::npos);
    }

    /** Founders, and the times at which a run asks: the ends of steps and the
     *  moments between them. */
    template <int dim>
    struct Asked
    {
      const std::vector<Point<dim>> &places;
      std::vector<double>            times; // day
      double                         n;     // of all ranks' places, and times
      MPI_Comm                       comm;
    };

    template <int dim>
    Asked<dim>
    asked_of(const Scene         &scene,
             const Founders<dim> &founders,
             const bool           only_ends,
             const MPI_Comm       comm)
    {
      const double end = scene.time.end_time, step = scene.time.step;
      const double n = std::ceil(end / step - 1e-9);
      Asked<dim>   asked{founders.positions, {}, n * founders.n_global, comm};
      constexpr double most = 1e6;
      if (n <= most)
        for (double i = 0.; i <= n; ++i)
          {
            asked.times.push_back(std::min(i * step, end));
            if (!only_ends && i < n)
              asked.times.push_back(std::min((i + 0.5) * step, end));
          }
      return asked;
    }

    /**
     * Whether a value never acts: that of no type at any founder at any time.
     * False where the state of cells decides, where asking would take long, and
     * where a value cannot be had, which is refused elsewhere. Collective.
     * @param acts what a value must be to act
     */
    template <int dim, typename Acts>
    bool
    never_acts(const ExpressionKey &key,
               const Asked<dim>    &asked,
               const Acts          &acts)
    {
      constexpr double most_values = 1e6;
      if (!is_of_place_and_time(key, dim))
        return false;
      const Expression               &base = key.expression(dim);
      std::vector<const Expression *> all  = {&base};
      for (const auto &[type, own] : base.types())
        all.push_back(&own);
      const bool of_time = base.depends_on_time();
      if (of_time && asked.n > most_values)
        return false;
      // The first value that acts ends the search: few are asked for but where
      // nothing happens.
      const auto any = [&](const double t) {
        return std::any_of(
          asked.places.begin(), asked.places.end(), [&](const auto &X) {
            return std::any_of(all.begin(), all.end(), [&](const auto *one) {
              return acts(one->value(X, t));
            });
          });
      };
      bool found = false;
      try
        {
          found = of_time ?
                    std::any_of(asked.times.begin(), asked.times.end(), any) :
                    any(0.);
        }
      catch (const std::exception &)
        {
          found = true;
        }
      return Utilities::MPI::max(found ? 1 : 0, asked.comm) == 0;
    }

    /** Cells that never enter S. */
    template <int dim>
    void
    review_cycle(const Scene &scene, const Asked<dim> &asked, Review &review)
    {
      if (!scene.has_proliferation())
        return;
      const CellCycleParameters &cycle = scene.cell_cycle;
      const auto is_positive = [](const double rate) { return rate > 0.; };
      if (cycle.start == "waiting" &&
          never_acts(cycle.exit_rate, asked, is_positive))
        review.warn(cycle.exit_rate.path(),
                    cycle.exit_rate.text(),
                    "all cells wait in G0 at t = 0, and none ever leaves it: "
                    "no cell divides.",
                    "Set a rate > 0, or " + cycle.start.path() +
                      " = together.");
      const Expression &checkpoint =
        cycle.size_checkpoint.expression(scene.dimension);
      if (checkpoint.is_constant() && checkpoint.number() &&
          *checkpoint.number() >= 1.)
        review.warn(cycle.size_checkpoint.path(),
                    cycle.size_checkpoint.text(),
                    "cells at rest have J_e = 1, which is not above it: only "
                    "stretched cells enter S.",
                    "Choose a number below 1.");
    }

    /** Growth that is none. */
    template <int dim>
    void
    review_growth(const Scene &scene, const Asked<dim> &asked, Review &review)
    {
      const auto &rate    = scene.keys<RateGrowthParameters>();
      const auto &stretch = scene.keys<IsotropicGrowthParameters>().stretch;
      const auto  is_other_than = [](const double neutral) {
        return [neutral](const double value) { return value != neutral; };
      };
      const bool by_rate = scene.law_of_growth() == "rate";
      if (!(by_rate ? never_acts(rate.rate, asked, is_other_than(0.)) &&
                        never_acts(rate.homeostasis, asked, is_other_than(0.)) :
                      scene.law_of_growth() == "isotropic" &&
                        never_acts(stretch, asked, is_other_than(1.))))
        return;
      const ExpressionKey &key = by_rate ? rate.rate : stretch;
      review.warn(scene.growth_law.path(),
                  scene.law_of_growth(),
                  "no cell grows: " + (is_set(key) ?
                                         key.path() + " = " + key.text() +
                                           " is " + (by_rate ? "0" : "1") +
                                           " at all founders in all steps." :
                                         "its keys have their defaults."),
                  "Set them in the section Growth, or remove the law.");
    }

    /** Rates of events that are 0 for all cells. */
    template <int dim>
    void
    review_events(const Scene &scene, const Asked<dim> &asked, Review &review)
    {
      const auto warn = [&](const ExpressionKey &key,
                            const double         neutral,
                            const std::string   &so) {
        if (is_set(key) &&
            never_acts(key, asked, [neutral](const double value) {
              return value != neutral;
            }))
          review.warn(key.path(),
                      key.text(),
                      "it is " + std::string(neutral == 0. ? "0" : "1") +
                        " at all founders in all steps: " + so,
                      "Correct it, or remove it.");
      };
      warn(scene.keys<DeathParameters>().rate, 0., "no cell dies by it.");
      warn(scene.keys<ExtrusionParameters>().rate, 0., "no cell leaves by it.");
      warn(scene.keys<RearrangementParameters>().diffusion,
           0.,
           "no cell changes its place by it.");
      warn(scene.keys<ContractionParameters>().stretch,
           1.,
           "no cell contracts.");
      for (const CellTypeKeys &type : scene.cell_types.types)
        for (const ExpressionKey &rate : type.transitions)
          warn(rate, 0., "no cell changes its type by it.");
    }

    /** Death of nobody: a condition that holds at no founder in no step. */
    template <int dim>
    void
    review_death(const Scene &scene, const Asked<dim> &ends, Review &review)
    {
      const ExpressionKey &when = scene.keys<DeathParameters>().when;
      if (is_set(when) &&
          never_acts(when, ends, [](const double value) { return value > 0.; }))
        review.warn(when.path(),
                    when.text(),
                    "it holds for no founder at the beginning or end of any "
                    "step: no cell dies by it.",
                    "Correct it, or remove it.");
    }
  } // namespace


  template <int dim>
  void
  review_idle_rates(const Scene         &scene,
                    const Founders<dim> &founders,
                    const MPI_Comm       comm,
                    Review              &review)
  {
    // A number that is never 0 is found at the first founder. All ranks go
    // through the same keys, as each search is collective.
    const Asked<dim> moments = asked_of(scene, founders, false, comm);
    review_cycle(scene, moments, review);
    review_growth(scene, moments, review);
    review_events(scene, moments, review);
    review_death(scene, asked_of(scene, founders, true, comm), review);
  }


  template void
  review_idle_rates(const Scene &,
                    const Founders<2> &,
                    const MPI_Comm,
                    Review &);
  template void
  review_idle_rates(const Scene &,
                    const Founders<3> &,
                    const MPI_Comm,
                    Review &);
} // namespace Morula
