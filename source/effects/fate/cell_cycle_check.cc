// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/base/time_parameters.h>
#include <morula/effects/effect.h>
#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/scene_keys.h>
#include <morula/effects/state/present_cell.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** The text that ends "what is allowed" with the value at one cell. */
    template <int dim>
    std::string
    value_at(const double value, const Point<dim> &X)
    {
      std::ostringstream text;
      text << "; it is " << value << " for the cell at (" << X << ") um";
      return text.str();
    }
  } // namespace


  template <int dim>
  void
  review_cell_cycle(const CellCycleParameters &parameters,
                    const Preview<dim>        &scene,
                    Review                    &review)
  {
    // Cells that never enter S come first. Then the shortest cycle of all
    // founders that proliferate is compared with the step. A duration that
    // depends on the state or the time is left to the run. All ranks return
    // there together, as the expression is the same on all, so the minimum is
    // reached by all or none.
    const Expression &exit_rate = parameters.exit_rate.expression(dim);
    if (parameters.start == "waiting" &&
        never_acts<dim>(
          exit_rate,
          [](const double rate) { return rate > 0.; },
          AskedAt::all_moments,
          scene))
      review.warn(exit_rate.key(),
                  exit_rate.text(),
                  "all cells wait in G0 at t = 0, and none ever leaves it: "
                  "no cell divides.",
                  "Set a rate > 0, or " + parameters.start.path() +
                    " = together.");
    const Expression &checkpoint = parameters.size_checkpoint.expression(dim);
    if (checkpoint.is_constant() && *checkpoint.number() >= 1.)
      review.warn(checkpoint.key(),
                  checkpoint.text(),
                  "cells at rest have J_e = 1, which is not above it: only "
                  "stretched cells enter S.",
                  "Choose a number below 1.");

    const Expression &duration = parameters.duration.expression(dim);
    const Expression &where    = parameters.where.expression(dim);
    if (depends_on_more_than_place(duration))
      return;
    double shortest = std::numeric_limits<double>::max();
    for (const Point<dim> &X : scene.founders)
      if (where.value(X, 0.) > 0.)
        shortest = std::min(shortest, duration.value(X, 0.));
    shortest = Utilities::MPI::min(shortest, scene.comm);
    // Without any proliferating founder the minimum is huge and nothing is
    // said.
    if (scene.keys.time.step > (0.25 + 1e-9) * shortest)
      review.warn(TimeParameters::step_path,
                  as_text(scene.keys.time.step) + " day",
                  "that is " + as_text(scene.keys.time.step / shortest) +
                    " of the shortest cell cycle, " + as_text(shortest) +
                    " day; measured are steps of up to a quarter "
                    "(doc/accuracy-and-cost.md, advice; doc/hard-cases.md, "
                    "showcase).",
                  "Shorten the step to 0.1 or 0.2 of the cycle.");
  }


  template <int dim>
  CellCycle<dim>::CellCycle(const CellCycleParameters &parameters,
                            const std::uint64_t        seed,
                            const double               slack)
    : CellCycle(parameters, seed, slack, StateColumns<dim>())
  {}


  template <int dim>
  CellCycle<dim>::CellCycle(const CellCycleParameters &parameters,
                            const std::uint64_t        seed,
                            const double               slack,
                            StateColumns<dim>        &&own)
    : CellCycle(parameters, seed, slack, own)
  {}


  template <int dim>
  CellCycle<dim>::CellCycle(const CellCycleParameters &parameters,
                            const std::uint64_t        seed,
                            const double               slack,
                            StateColumns<dim>         &state)
    : duration(state.use(parameters.duration))
    , exit_rate(state.use(parameters.exit_rate))
    , size_checkpoint(state.use(parameters.size_checkpoint))
    , where(parameters.where.expression(dim))
    , start_together(parameters.start == "together")
    , seed(seed)
    , slack(slack)
    // The flags are kept, as they are asked for each cell in each step: whether
    // an expression needs the state decides which columns the cycle has.
    , own_duration(depends_on_more_than_place(duration))
    , own_hazard(depends_on_more_than_place(exit_rate))
    , exit_rate_follows_state(exit_rate.follows_state())
  {}


  template <int dim>
  void
  CellCycle<dim>::check(const std::vector<Point<dim>> &founders,
                        const double                   step) const
  {
    // This is the check before there are cells: only expressions of X can be
    // evaluated.
    double shortest = std::numeric_limits<double>::infinity();
    for (const Point<dim> &X : founders)
      if (where.value(X, 0.) > 0.)
        shortest = std::min(shortest, checked_duration(X, X, false));
    check_step(shortest, step);
  }


  template <int dim>
  void
  CellCycle<dim>::check_cell(const CellAt<dim> &founder,
                             const double       step) const
  {
    // This is the check at a founder with its state, for all expressions that
    // need it.
    const Point<dim> X = founder.present()->cell().founder_position();
    if (!(where.value(X, 0.) > 0.))
      return;
    check_step(checked_duration(founder, X, true), step);
  }


  template <int dim>
  double
  CellCycle<dim>::checked_duration(const CellAt<dim> &at,
                                   const Point<dim>  &X,
                                   const bool         in_its_state) const
  {
    // Two callers share this function. check() has no cell and evaluates the
    // expressions of X alone; check_cell() has one and evaluates the rest. An
    // expression that is not this caller's is NaN, with which every comparison
    // below is false.
    const auto value = [&](const Expression &expression) {
      return depends_on_more_than_place(expression) == in_its_state ?
               at.value(expression) :
               std::numeric_limits<double>::quiet_NaN();
    };
    const double T = value(duration);
    if (T <= 0.)
      throw InputError(duration.key(),
                       duration.text(),
                       "a positive duration in days" + value_at(T, X),
                       "Make it positive wherever cells proliferate, or "
                       "exclude these cells by 'Where'.");

    const double rate = value(exit_rate);
    if (rate < 0.)
      throw InputError(exit_rate.key(),
                       exit_rate.text(),
                       "a rate per day that is not negative" +
                         value_at(rate, X),
                       "Use 0 for cells that never leave G0.");

    const double threshold = value(size_checkpoint);
    if (threshold < 0.)
      throw InputError(size_checkpoint.key(),
                       size_checkpoint.text(),
                       "a volume ratio that is not negative" +
                         value_at(threshold, X),
                       "Use 0 for no checkpoint.");
    // A duration that is not known here must not shorten the step.
    return std::isnan(T) ? std::numeric_limits<double>::infinity() : T;
  }


  template <int dim>
  void
  CellCycle<dim>::check_step(const double shortest, const double step) const
  {
    // A cell divides T/2 after the onset and could divide twice in a longer
    // step; only one division per step is provided for. The slack admits a step
    // of T/2 with rounding.
    if (step <= 0.5 * shortest + slack)
      return;
    std::ostringstream value, limit;
    value << step;
    limit << "at most half the shortest cell cycle, " << 0.5 * shortest
          << " day";
    throw InputError(TimeParameters::step_path,
                     value.str(),
                     limit.str(),
                     "Shorten the step, or lengthen " + duration.key() + ".");
  }


  MORULA_INSTANTIATE(review_cell_cycle);
#define INSTANTIATE(dim)                                                      \
  template CellCycle<dim>::CellCycle(const CellCycleParameters &,             \
                                     const std::uint64_t,                     \
                                     const double);                           \
  template CellCycle<dim>::CellCycle(const CellCycleParameters &,             \
                                     const std::uint64_t,                     \
                                     const double,                            \
                                     StateColumns<dim> &);                    \
  template void CellCycle<dim>::check(const std::vector<Point<dim>> &,        \
                                      const double) const;                    \
  template void CellCycle<dim>::check_cell(const CellAt<dim> &, const double) \
    const;
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
