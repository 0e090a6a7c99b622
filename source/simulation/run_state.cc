// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/base/version.h>
#include <morula/simulation/run_state.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>

namespace Morula
{
  namespace
  {
    /** The most steps before a longer one is tried again. */
    constexpr unsigned int most_patience = 32;

    /** The drag that tissue is first held back with, and at most: it resists a
     *  motion by h with a stress of a tenth of E, or a hundred times E. */
    constexpr double first_drag = 1e3, strongest_drag = 1e6;

    /** How much stronger it becomes where a step fails, and how much stronger
     *  or weaker after one: so that no strand turns by more than half of what
     *  it may in a step, as one that folds turns twice as far in the next. */
    constexpr double change_of_drag = 4., small_change = 2., most_of_turn = 0.5;

    /** Steps that are held back are Step/4 or shorter. In longer ones tissue
     *  would grow far under the drag, which then chooses how it folds. */
    constexpr unsigned int level_of_drag = 2;
  } // namespace


  template <int dim>
  double
  mean_over_tissue(const Tissue<dim>                               &tissue,
                   const std::function<double(const unsigned int)> &number,
                   const double                                     scale)
  {
    // Sums of integers do not depend on their order, and so not on the number
    // of ranks. With units of 2^-30 typical volumes and at most 2^10 of these a
    // cell, 2^23 cells of the largest size do not overflow 64 bits.
    constexpr double units  = 1u << 30;
    constexpr double most   = 1024.;
    std::int64_t     all[2] = {0, 0};
    const auto      &cells  = tissue.cells();
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const double volume = std::min(cells.volume(p) / scale, most);
        all[0] += std::llround(units * volume * std::clamp(number(p), 0., 1.));
        all[1] += std::llround(units * volume);
      }
    const MPI_Comm     comm  = tissue.communicator();
    const std::int64_t part  = Utilities::MPI::sum(all[0], comm);
    const std::int64_t whole = Utilities::MPI::sum(all[1], comm);
    return whole > 0 ? double(part) / double(whole) : 0.;
  }


  MORULA_INSTANTIATE(mean_over_tissue);


  TimeSteps::TimeSteps(const TimeParameters &parameters)
    : parameters(parameters)
    , state_({0., parameters.step, 0, 0., 0, 0, 0., false})
  {
    begin_anew();
  }

  void
  TimeSteps::restore(const State &state)
  {
    // With the same Time/Step and no other end of the interval the sequence
    // goes on to the bit. Otherwise a new interval begins at the snapshot's
    // time and ends at the next multiple of the new Step.
    state_ = state;
    if (state.step == parameters.step && time() == state.time)
      return;
    state_.step = parameters.step;
    state_.interval =
      static_cast<unsigned int>(state.time / parameters.step + time_slack);
    state_.begin = state.time;
    state_.part = state_.level = 0;
  }

  void
  TimeSteps::adapt(const double mu)
  {
    // This is doc/theory.md (5.11). What the last step missed goes with the
    // square of its length, which tells what the next one would miss. A longer
    // step is tried first, and by one level only; it must begin at a multiple
    // of its own length, so that steps do not cross the intervals' ends. The
    // first step and that after a cut are not made longer.
    if (parameters.tolerance <= 0.)
      return;
    const bool anew = std::exchange(state_.anew, false);
    // Only a doubled step that stays well below the tolerance is worth it.
    // Without this margin lengths would swing: a step would be doubled, and
    // halved again.
    const double     ratio      = next() - time() > 0. && past().exists() ?
                                    past().length() / (next() - time()) :
                                    1.;
    constexpr double hysteresis = 2.; // this is √2 in the length
    double           error      = mu / (ratio * ratio);
    if (!anew && state_.level > 0 && state_.part % 2 == 0 && may_grow() &&
        4. * hysteresis * error <= parameters.tolerance)
      {
        state_.part /= 2;
        --state_.level;
        return;
      }
    for (; error > parameters.tolerance && can_halve(); error /= 4.)
      halve();
  }

  void
  TimeSteps::begin_anew()
  {
    // Nothing is known yet of what the next step will miss, so that it is
    // short: Step/16, doc/theory.md, section 5.11. Longer ones follow by a
    // factor of two a step.
    constexpr unsigned int first_level = 4;
    if (parameters.tolerance <= 0.)
      return;
    state_.anew = true;
    while (state_.level < first_level && can_halve())
      halve();
  }

  void
  TimeSteps::learn()
  {
    // A step that fails several times is one failure.
    if (state_.good > 0)
      state_.patience = std::min(2 * state_.patience, most_patience);
    state_.good = 0;
  }

  bool
  TimeSteps::hold_back(const bool is_too_long)
  {
    if (state_.drag >= strongest_drag)
      return false;
    learn();
    if (!is_too_long || state_.level >= level_of_drag || !can_halve())
      state_.drag =
        state_.drag == 1. ? first_drag : change_of_drag * state_.drag;
    while (state_.level < level_of_drag && can_halve())
      halve();
    return true;
  }

  void
  TimeSteps::accept(const double turn)
  {
    // Three things can follow a step. Its interval is done: the next one
    // begins, with steps as long as before if Tolerance chooses them, else with
    // Step. Or two halves are done, and the next step is twice as long again.
    // Or the next step is as long as this one. With Tolerance adapt() decides,
    // and not this function. Longer steps are not tried before as many have
    // succeeded as failures have taught. When three times as many have, they
    // have taught half as much. A drag goes first, little by little.
    state_.past = time();
    ++state_.part;
    if (++state_.good >= 3 * state_.patience && state_.patience > 1)
      {
        state_.patience /= 2;
        state_.good = state_.patience;
      }
    const bool grows = parameters.tolerance <= 0. && may_grow();
    if (turn > most_of_turn)
      state_.drag = std::min(strongest_drag, small_change * state_.drag);
    else if (state_.good >= state_.patience &&
             small_change * turn <= most_of_turn)
      state_.drag = std::max(1., state_.drag / small_change);
    if (state_.part == 1u << state_.level)
      {
        // An interval that End time has cut is not finished: a resumed run with
        // a later End time may go on in it.
        const double end = end_of_interval();
        if (end >= (state_.interval + 1 - time_slack) * parameters.step)
          ++state_.interval;
        state_.begin = end;
        state_.part  = 0;
        if (grows)
          state_.level = 0;
      }
    else if (grows && state_.level > 0 && state_.part % 2 == 0)
      {
        state_.part /= 2;
        --state_.level;
      }
    state_.time = time();
  }


  namespace
  {
    /** Calls visit(name, number) for the numbers that every snapshot has, and
     *  visit(name, number, otherwise) for others, which are `otherwise` if it
     *  has them not. */
    template <typename Steps, typename State, typename Visit>
    void
    for_numbers(Steps &steps, State &state, const Visit &visit)
    {
      visit("next_id", state.next_id);
      visit("steps", state.n_steps);
      visit("rejected_steps", state.n_rejected);
      visit("step_length", steps.step);
      visit("step_interval", steps.interval);
      visit("step_begin", steps.begin);
      visit("step_part", steps.part);
      visit("step_level", steps.level);
      // Without the last step's begin the first step compares nothing with the
      // step before.
      visit("last_step_begin", steps.past, steps.time);
      visit("step_anew", steps.anew, 0.);
      visit("step_patience", steps.patience, 1.);
      visit("good_steps", steps.good, 1.);
      visit("drag", steps.drag, 1.);
      visit("next_boundary_id", state.next_boundary_id, 0.);
      visit("surface_way", state.surface_way, 0.);
      visit("missed_flow", state.error.flow, 0.);
      visit("step_error", state.error.last, 0.);
      visit("sum_of_errors", state.error.sum, 0.);
    }

    /** Stands for what a number is otherwise that must be there. */
    const double needed = std::numeric_limits<double>::quiet_NaN();
  } // namespace


  template <int dim>
  SnapshotData<dim>
  snapshot_of(const Tissue<dim>      &tissue,
              const TimeSteps::State &time_steps,
              const RunState         &state)
  {
    // What a step needs of the steps before it is stored, by names: numbers
    // first, then the box of the grid and the weights of its last partition
    // (they decide owners and the order of sums, so that a resumed run has the
    // same bits), then this rank's points with the layout of their columns.
    // Integers up to 2^53 are exact as numbers.
    SnapshotData<dim> data;
    data.program_version = version_number();
    data.time            = time_steps.time;
    for_numbers(time_steps,
                state,
                [&](const char  *name,
                    const double value,
                    const double otherwise = needed) {
                  if (value != otherwise)
                    data.numbers[name] = value;
                });
    data.numbers.insert(state.kept.begin(), state.kept.end());
    if (state.enclosed_share)
      data.numbers["enclosed_share"] = *state.enclosed_share;
    if (!state.walls.empty())
      data.tables["walls"] = state.walls;
    const GridBox<dim> &box = tissue.grid().box();
    data.integer_tables["box_first"].assign(box.first().begin(),
                                            box.first().end());
    data.integer_tables["box_n"].assign(box.n().begin(), box.n().end());
    data.grid_weights     = tissue.grid().weights();
    data.cells            = tissue.cells().copy();
    data.boundary_points  = tissue.boundary_points().copy();
    data.cell_columns     = tissue.cells().columns().layout();
    data.boundary_columns = tissue.boundary_points().columns().layout();
    return data;
  }


  template <int dim>
  void
  restore_tissue(SnapshotData<dim> &data, Tissue<dim> &tissue)
  {
    // The box is the same on all ranks; each rank has a part of the weights, so
    // that only some ranks may find a wrong one. Tissue::restore() makes the
    // same grid and partition as before, which needs numbers inside the box.
    const std::vector<int> &box_first = data.integer_table("box_first", dim);
    const std::vector<int> &box_n     = data.integer_table("box_n", dim);
    GridIndex<dim>          first, n;
    std::size_t             n_grid_cells = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        first[d] = box_first[d];
        n[d]     = box_n[d];
        if (box_n[d] <= 0)
          refuse_snapshot(data.file, "a snapshot whose grid has cells");
        n_grid_cells *= box_n[d];
      }
    everywhere(tissue.communicator(), [&]() {
      for (const GridCellCount &weight : data.grid_weights)
        if (weight.number >= n_grid_cells)
          refuse_snapshot(data.file,
                          "a snapshot with weights of its own grid cells");
    });
    tissue.restore(std::move(data.cells),
                   std::move(data.boundary_points),
                   first,
                   n,
                   data.grid_weights);
  }


  template <int dim>
  std::pair<TimeSteps::State, RunState>
  saved_state(const SnapshotData<dim> &data, const NamedNumbers &kept)
  {
    // number() refuses a snapshot that lacks what it must have. A kept number
    // whose name ends with '/' stands for all that begin with it.
    TimeSteps::State steps{};
    RunState         state;
    steps.time = data.time;
    for_numbers(
      steps,
      state,
      [&](const char *name, auto &value, const double otherwise = needed) {
        value = std::isnan(otherwise) || data.numbers.count(name) > 0 ?
                  data.number(name) :
                  otherwise;
      });
    state.kept = kept;
    for (auto &[name, value] : state.kept)
      if (data.numbers.count(name) > 0)
        value = data.number(name);
    for (const auto &[name, value] : data.numbers)
      if (kept.count(name.substr(0, name.find('/') + 1)) > 0)
        state.kept[name] = value;
    // Snapshots of versions that did not know the share do not have it.
    if (data.numbers.count("enclosed_share") > 0)
      state.enclosed_share = data.number("enclosed_share");
    if (data.tables.count("walls") > 0)
      state.walls = data.table("walls");
    return {steps, state};
  }


  MORULA_INSTANTIATE(snapshot_of);
  MORULA_INSTANTIATE(restore_tissue);
  MORULA_INSTANTIATE(saved_state);
} // namespace Morula
