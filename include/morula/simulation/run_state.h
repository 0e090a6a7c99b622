// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_run_state_h
#define morula_simulation_run_state_h

#include <morula/base/past_step.h>
#include <morula/base/time_parameters.h>
#include <morula/effects/tables.h>
#include <morula/output/snapshot.h>
#include <morula/particles/tissue.h>

#include <cmath>
#include <functional>
#include <optional>
#include <utility>

namespace Morula
{
  /** The estimate of a run's error in time: doc/theory.md (5.10). */
  struct ErrorInTime
  {
    /** What the last step missed of flow, relative to the volume. It is known
     * at the step's end, while what is missed of growth is known only when the
     *  next step begins. */
    double flow = 0.;
    /** What the step before the last missed of growth. */
    double last = 0.;
    /** The sum of (5.10). */
    double sum = 0.;

    /** Adds what steps have missed: of growth, relative to the volume, and what
     *  is known of flow, along an axis. */
    template <int dim>
    void
    add(const double growth)
    {
      // This is the sum in doc/theory.md (5.10). A deviator's norm is larger
      // than its value along its axis.
      sum += 5. / 6. *
             (std::abs(growth - last) + std::sqrt((dim - 1.) / dim) * flow);
      last = growth;
    }

    /** The error of the whole run, E of (5.10): relative, as a volume or a
     *  strain. */
    double
    total() const
    {
      return sum + last;
    }
  };

  /**
   * The mean of a number of each cell over the tissue's volume. The sums are
   * those of integers, so that the mean is the same for any number of ranks: it
   * decides how long steps are. Collective.
   * @param number not negative; above 1 it counts as 1
   * @param scale  a typical volume of a cell, µm^dim
   */
  template <int dim>
  double
  mean_over_tissue(const Tissue<dim>                               &tissue,
                   const std::function<double(const unsigned int)> &number,
                   const double                                     scale);

  /**
   * The time steps. Each step ends at a multiple of Step; the last one ends at
   * End time. A rejected step is halved inside its interval. After two halves
   * the next step is twice as long again; where longer steps go on failing,
   * after more of them, up to 32, as failed ones cost most. With Tolerance
   * steps are Step/2^k, as long as adapt() finds: doc/theory.md, section 5.11.
   * Times are computed as multiples and never as sums, so that they do not
   * drift.
   */
  class TimeSteps
  {
  public:
    explicit TimeSteps(const TimeParameters &parameters);

    /** The place of the run in the sequence of steps, for a snapshot. */
    struct State
    {
      double       time;             // present time, day
      double       step;             // Step, day
      unsigned int interval;         // the interval ends at (interval + 1) Step
      double       begin;            // of the interval, day
      unsigned int part;             // steps of this level that are done
      unsigned int level;            // the interval is cut into 2^level steps
      double       past     = 0.;    // when the last step began, day
      bool         anew     = false; // the next step does not follow that one
      unsigned int patience = 1;     // steps before a longer one is tried
      unsigned int good     = 1;     // steps since one has failed
      double       drag     = 1.;    // that holds the tissue back: hold_back()
    };

    State
    state() const
    {
      return state_;
    }

    /** Continues from @p state. Step and End time may have changed. */
    void
    restore(const State &state);

    /** Present time, day. */
    double
    time() const
    {
      return at(state_.part);
    }

    /** The step that led to the present state. */
    PastStep
    past() const
    {
      return {state_.past, time()};
    }

    /** End of the next step, day. */
    double
    next() const
    {
      return at(state_.part + 1);
    }

    /** Makes the next step as long as the error @p mu of the last one allows,
     *  doc/theory.md (5.11): shorter at once, longer by a factor 2 at most.
     * Does nothing without Tolerance. */
    void
    adapt(const double mu);

    /** Makes the next step short, as after a cut. Does nothing without
     *  Tolerance. */
    void
    begin_anew();

    bool
    finished() const
    {
      return time() >= parameters.end_time - time_slack * parameters.step;
    }

    /** Records that the step has succeeded.
     *  @param turn the largest turn of a strand that was held back, in units of
     *         the largest one allowed */
    void
    accept(const double turn = 0.);

    /** Whether half the next step is at least Smallest step. */
    bool
    can_halve() const
    {
      // Below level 30 the number of parts of an interval fits in an unsigned
      // int.
      return 0.5 * (next() - time()) >=
               parameters.smallest_step * (1. - time_slack) &&
             state_.level < 30;
    }

    /**
     * Records that the step has failed. The next one is half as long.
     * @return whether the next step is at least Smallest step
     */
    bool
    reject()
    {
      if (!can_halve())
        return false;
      learn();
      halve();
      return true;
    }

    /**
     * Records that a step has failed in which folds have contact. A fold that
     * snaps moves far however short the step is, and surfaces that were far
     * apart may meet on the way: doc/theory.md, section 4.3a. So the next steps
     * are short, and a drag holds the tissue back in them. It is given in units
     * of the weak drag of contact, and is 1 in all other steps.
     * @param is_too_long whether the step has only gone too far, so that it is
     *        made shorter without a drag, if it can be
     * @return whether the tissue can be held back more than it was
     */
    bool
    hold_back(const bool is_too_long);

  private:
    /** Takes a failure into account. */
    void
    learn();

    /** Whether a longer step may be tried. */
    bool
    may_grow() const
    {
      return state_.good >= state_.patience && state_.drag == 1.;
    }

    double
    end_of_interval() const
    {
      // A last step within rounding of End time would be too short to solve. A
      // multiple of Step within rounding of End time stays what it is in a
      // longer run, so that a resumed run has the same bits.
      const double end = (state_.interval + 1) * parameters.step;
      return end > parameters.end_time + time_slack * parameters.step ?
               parameters.end_time :
               end;
    }

    double
    at(const unsigned int part) const
    {
      // Times are multiples of a part and no sums of steps. The end of the
      // interval is taken as it is, so that intervals fit together to the bit.
      const unsigned int parts = 1u << state_.level;
      return part == parts ?
               end_of_interval() :
               state_.begin +
                 part * ((end_of_interval() - state_.begin) / parts);
    }

    /** Cuts the next step in two. The present time stays as it is. */
    void
    halve()
    {
      // The time stays: twice as many parts of half the length are done.
      state_.part *= 2;
      ++state_.level;
    }

    TimeParameters parameters;
    State          state_;
  };

  /** What outlives a step besides the tissue. */
  struct RunState
  {
    types::particle_index next_id          = 0; // of cells
    types::particle_index next_boundary_id = 0; // if the surface is refined
    unsigned int          n_steps          = 0;
    unsigned int          n_rejected       = 0;
    /** Numbers of the effects: Tables::kept(). */
    NamedNumbers kept = {};
    /** The volume that the surface enclosed at t = 0 over that of the cells;
     *  nothing if it was not closed. */
    std::optional<double> enclosed_share = {};
    /** walls_of() the surface at t = 0, if it is made from the cells. */
    std::vector<double> walls = {};
    /** How far the surface has moved at most since it was made from the cells,
     *  µm. */
    double surface_way = 0.;
    /** The estimated error of the steps so far. */
    ErrorInTime error = {};
  };

  /** Everything that outlives a step, for snapshot.h5; the files of the run add
   *  their own. */
  template <int dim>
  SnapshotData<dim>
  snapshot_of(const Tissue<dim>      &tissue,
              const TimeSteps::State &time_steps,
              const RunState         &state);

  /** Fills the tissue with the points of a snapshot, which are taken out of it.
   *  Collective. @throws InputError where the snapshot lacks anything */
  template <int dim>
  void
  restore_tissue(SnapshotData<dim> &data, Tissue<dim> &tissue);

  /** The place in the sequence of steps, and the run state.
   *  @param kept the numbers of the effects at t = 0: what the snapshot does
   * not know of them is that @throws InputError where it lacks anything */
  template <int dim>
  std::pair<TimeSteps::State, RunState>
  saved_state(const SnapshotData<dim> &data, const NamedNumbers &kept);
} // namespace Morula

#endif
