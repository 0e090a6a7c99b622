// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_simulation_h
#define morula_simulation_simulation_h

#include <morula/effects/equation.h>
#include <morula/effects/state/present_cell.h>
#include <morula/effects/volumes_of_step.h>
#include <morula/mechanics/plain_kernels.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/scene/tissue_model.h>
#include <morula/simulation/following_surface.h>
#include <morula/simulation/run_files.h>
#include <morula/simulation/run_state.h>
#include <morula/simulation/step_equilibrium.h>
#include <morula/simulation/stop_signals.h>
#include <morula/simulation/watches.h>

#include <deal.II/base/timer.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  struct FailedStep;

  /**
   * One run of a scene. Owns the parts, and is the only type that sees them
   * all; run() and step() read as the algorithm of section 2 of the paper.
   */
  template <int dim>
  class Simulation
  {
  public:
    /**
     * Seeds the tissue, or reads the snapshot. Touches no file.
     * @throws InputError for a scene that cannot be run
     */
    Simulation(const Scene &scene, const MPI_Comm comm, const bool resume);

    /** A new run from the result of seed_tissue() for the same scene. */
    Simulation(const Scene             &scene,
               const MPI_Comm           comm,
               const SeededTissue<dim> &seeded);

    /**
     * Runs to End time.
     * @param observe called on all ranks with the initial state, or that of the
     *        snapshot, and after every step; it may read this object
     * @throws std::runtime_error if a step fails at Smallest step, with the
     *         time and how to resume; the last good state is saved
     * @throws StoppedBySignal if SIGINT, SIGTERM, SIGHUP or SIGUSR1 asked for
     * it, after the step in which it came; the state is saved
     */
    void
    run(const std::function<void()> &observe = {});

    /** Cells and boundary points as they are now. */
    const Tissue<dim> &
    state() const
    {
      return tissue;
    }

    /** The row of statistics.csv for the present state and the step that led to
     *  it. */
    const StatisticsRow &
    last_row() const
    {
      return row;
    }

    /** Mechanics of cell number @p p of the present state, in the order of
     *  Tissue::cells(), as in cells-NNNN.csv. */
    CellQuantities
    quantities(const unsigned int p) const
    {
      // The reader evaluates expressions of the cells with the present time.
      const CellReader<dim> reader =
        model.development.reader(time_steps.time());
      return present_cell(tissue, p, reader).quantities();
    }

    /** Size of the first step's equations, for --explain. Collective. */
    unsigned int
    n_unknowns()
    {
      return dim * splines().n_unknowns();
    }

    /** The part of the grown volume that shares a pool with unlike cells at
     *  t = 0, for --explain: doc/theory.md, section 2.4. Collective. */
    double
    mixed_share();

    /** The largest friction ζ of cells over the typical stiffness, day/µm², for
     *  --explain. Collective. */
    double
    friction_over_stiffness() const;

  private:
    Simulation(const Scene &scene, const MPI_Comm comm);
    void
    seed(const SeededTissue<dim> &seeded);
    void
    restore();

    /** Gives founders their state anew, when the steady fields are known.
     *  @param all whether all are still there. Collective. */
    void
    found_again(const bool all);

    void
    begin();
    /** Takes out at t = 0 what Death/When kills then and goes at once, and
     *  closes the surface. @return whether that was anything. Collective. */
    bool
    carve();
    /** Brings tissue that follows its strain into balance with what acts on it
     *  at t = 0, where that takes no time: doc/theory.md, section 5.6.
     *  @return whether it has moved. Collective. */
    bool
    balance_at_start();
    bool
    must_stop() const;

    void
    step();
    void
    begin_step();
    /** Warns of tissue that is about to stick to other tissue. Collective. */
    void
    watch(const SplineSpace<dim> &space)
    {
      // Where folds have contact, tissue that comes near does not stick. A gap
      // closes in many steps, so that not each of them has to search.
      constexpr unsigned int every = 10;
      if (const std::string reason =
            watches.look_at_cells(tissue,
                                  run_state.walls,
                                  run_state.n_steps % every == 0,
                                  time_steps.time());
          !reason.empty())
        give_up(reason);
      if (run_state.n_steps % every == 1)
        watches.look_at_necks(tissue, time_steps.time());
      if (tissue.cells().has_parts())
        return;
      watches.look_at_pieces(space, comm, time_steps.time());
      if (run_state.n_steps % every == 1)
        watches.look_at_gaps(tissue, space, time_steps.time());
    }
    /** Moves the tissue to the end of the step. Collective. */
    void
    move(const SplineSpace<dim>                        &space,
         const SplineSpace<dim>                        &space_of_equations,
         const typename StepEquilibrium<dim>::Solution &solution);
    /** Divisions, deaths, exchanges of places and the surface at the end of the
     *  step. Collective. */
    void
    rearrange(const SplineSpace<dim> &space);
    /** With Time/Tolerance: makes the step as long as the error of the last one
     *  allows. Collective. */
    void
    adapt_step();
    /** The mean over the tissue of what each cell has missed in a step; 0 where
     *  no step's error is known. Collective. */
    double
    mean_missed(const std::vector<double> &missed) const
    {
      return model.development.states_error() ?
               mean_over_tissue<dim>(
                 tissue,
                 [&](const unsigned int p) {
                   return missed.empty() ? 0. : missed[p];
                 },
                 std::pow(double(model.scene.tissue.cell_spacing), dim)) :
               0.;
    }
    using MomentOfStep = void (Moments<dim>::*)(Tissue<dim> &,
                                                const MomentOfRun<dim> &) const;
    /** Calls this moment of all effects that have moments. Collective. */
    void
    for_moments(const MomentOfStep moment, const double t, const double dt)
    {
      // The effects change the tissue and the kept numbers in the order of the
      // scene's list, each in a section of its own in timings.csv.
      for (const auto &[name, effect] : model.moments)
        {
          const TimerOutput::Scope section(timer, name);
          const CellReader<dim>    reader = model.development.reader(t);
          (*effect.*moment)(
            tissue,
            {t, dt, reader, run_state.kept, of_step, [this](const auto &text) {
               files->message(text);
             }});
        }
    }
    SplineSpace<dim>
    splines();
    typename StepEquilibrium<dim>::Solution
    solve_step(const SplineSpace<dim> &space,
               const Encounters<dim>  *encounters);

    /** What may meet in the step; null without an interaction. Unknowns of
     *  others become relevant. Collective. */
    std::unique_ptr<const Encounters<dim>>
    encounters(SplineSpace<dim> &space)
    {
      if (!model.interaction)
        return nullptr;
      const TimerOutput::Scope section(timer, model.interaction->name);
      return model.interaction->effect->encounters(tissue, space);
    }

    /** The splines of equations, if they pass from body to body. Collective. */
    std::optional<SplineSpace<dim>>
    splines_of_equations(const SplineSpace<dim> &space) const
    {
      if (!space.is_parted() || equations.empty() ||
          !model.interaction->effect->lets_equations_pass())
        return {};
      return tissue.unparted_splines(model.material.volumetric_form() !=
                                     VolumetricStrain::pointwise);
    }
    typename StepEquilibrium<dim>::Solution
    try_step(const StepEquilibrium<dim> &equilibrium);
    void
    commit(const SplineSpace<dim>                        &space,
           const SplineSpace<dim>                        &space_of_equations,
           const typename StepEquilibrium<dim>::Solution &solution,
           const bool                                     takes_time = true);
    /** Deforms the cells at the end of the step by their motions.
     *  @param volumes  det F_e of each cell where its grid cell has one, else
     *                  empty
     *  @return what the forecast of flow has missed, by cell */
    std::vector<double>
    deform_cells(const std::vector<PointMotion<dim>> &motions,
                 const std::vector<VolumeOfStep>     &volumes);
    void
    divide();
    void
    remove_the_dead();
    /** Tissue/Redistribution. Collective. */
    void
    keep_places();

    /** Updates what the row says of the state, and keeps what it says of the
     *  step. */
    void
    describe_state();
    /** Says once where tissue without contact may have passed through itself.
     */
    void
    warn_of_turn(const SplineSpace<dim>       &space,
                 const DisplacementField<dim> &displacement);
    void
    complete_row();
    void
    count(const SplineSpace<dim> &space)
    {
      row.active_grid_cells = space.n_active_grid_cells();
      row.inner_splines     = space.n_inner_splines();
      row.outer_splines     = space.n_outer_splines();
      row.unknowns          = dim * space.n_unknowns();
    }
    /** How many events of this kind the step had. Collective. */
    std::uint64_t
    count(const EventKind &kind) const;
    /** Whether the surface encloses another part of the cells' volume than at
     *  t = 0, by 5 % or more. */
    bool
    surface_misfits() const
    {
      // Loads on the surface and fields that enter through it are wrong by as
      // much as the surface misfits. The user is told from 5 % on.
      return run_state.enclosed_share && row.cells > 0 &&
             std::abs(row.surface->share() / *run_state.enclosed_share - 1.) >
               0.05;
    }
    void
    write_rows();
    /** What Newton's method had to do in step number @p step, which has begun
     *  at @p begin (day): rows of condition.csv and newton.csv, where the scene
     *  asks for them. */
    void
    write_work(const unsigned int step, const double begin);
    void
    output(const bool last);
    SnapshotData<dim>
    snapshot() const
    {
      return snapshot_of(tissue, time_steps.state(), run_state);
    }
    /** Saves the state that the present step has begun with. @throws
     *  StoppedBySignal */
    void
    stop_if_asked();

    /** Gives cells the steady solutions of the configuration. Collective. */
    void
    settle_equations(const SplineSpace<dim> &space);
    /** Calls @p solve for all equations, and ends the run if it cannot. */
    void
    solve_equations(const std::function<void(EquationInRun<dim> &)> &solve);
    [[noreturn]] void
    give_up(const std::string &reason);
    [[noreturn]] void
    give_up_step(const std::string &reason);
    /** What is known of the step that has failed. */
    FailedStep
    failed_step() const;

    const TissueModel<dim> model;
    const MPI_Comm         comm;
    const Timer            clock;
    TimerOutput            timer;

    Tissue<dim>                tissue;
    TimeSteps                  time_steps;
    RunState                   run_state;
    double                     typical_stiffness = 0.; // kPa
    std::optional<StopSignals> signals;                // in run()
    /** What the present step has begun with, besides what no step changes
     * before move(); the cells' rows where equations have changed them. */
    struct
    {
      TimeSteps::State    time_steps;
      RunState            run_state;
      std::vector<double> rows;
    } begun = {};

    // What follows belongs to the present step.
    DevelopmentOfStep<dim>           growth_of_step;
    std::vector<Birth<dim>>          births; // on this rank
    std::vector<CellEvent>           events; // likewise
    std::vector<ForceRow>            forces; // at the end of the last step
    NewtonReport                     newton_report;
    StatisticsRow                    row;
    NamedNumbers                     of_step;   // columns of the effects
    std::optional<ConditionEstimate> condition; // if the scene asks for it
    /** The step's first attempt, if that has failed. */
    struct
    {
      double dt;    // day
      double force; // |R| where it began, kPa µm^(dim-1)
    } first_attempt = {0., 0.};

    Watches<dim>                                     watches;
    FollowingSurface<dim>                            surface;
    std::vector<std::unique_ptr<EquationInRun<dim>>> equations;
    bool warned_of_long_cells = false; // once a run, or before it started
    bool told_of_path         = false;
    bool told_of_turn         = false; // once a run
    bool warned_of_misfit     = false; // likewise
    bool warned_of_drift      = false; // likewise

    bool phases_are_given = false; // of founders, by their file

    // A new run says what acts in it, and its warnings, when it has a log.
    std::vector<std::string>         warnings;
    std::optional<SplineSpace<dim>>  first_splines; // until the first step
    std::optional<SnapshotData<dim>> resumed_from;  // until run()
    std::optional<RunFiles<dim>>     files;         // from run() on
  };
} // namespace Morula

#endif
