// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_simulation_h
#define morula_simulation_simulation_h

#include <morula/effects/development.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/grid/piece_watch.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/spline_field.h>
#include <morula/particles/tissue.h>
#include <morula/scene/scene.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/simulation/run_files.h>
#include <morula/simulation/stop_signals.h>
#include <morula/simulation/time_steps.h>
#include <morula/solver/newton.h>

#include <deal.II/base/timer.h>

#include <functional>
#include <optional>

namespace Morula
{
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

    /** A new run with what seed_tissue() has made of the same scene. */
    Simulation(const Scene             &scene,
               const MPI_Comm           comm,
               const SeededTissue<dim> &seeded);

    /**
     * Runs to End time.
     * @param observe called on all ranks with the initial state, or that of the
     *        snapshot, and after every step; it may read this object
     * @throws std::runtime_error if a step fails at Smallest step, with the
     *         time and how to resume; the last good state is saved
     * @throws StoppedBySignal where SIGINT, SIGTERM or SIGUSR1 asked for it,
     * after the step in which they came; the state is saved
     */
    void
    run(const std::function<void()> &observe = {});

    /** Cells and boundary points as they are now. */
    const Tissue<dim> &
    state() const;

    /** What statistics.csv says of the present state, and of the step to it. */
    const StatisticsRow &
    last_row() const;

    /** Mechanics of cell number @p p of the present state, in the order of
     *  Tissue::cells(), as in cells-NNNN.csv. */
    CellQuantities
    quantities(const unsigned int p) const;

    /** Size of the first step's equations, for --explain. Collective. */
    unsigned int
    n_unknowns();

  private:
    Simulation(const Scene        &scene,
               const MPI_Comm      comm,
               SceneEffects<dim> &&effects);
    void
    seed(const SeededTissue<dim> &seeded);
    void
    begin_lumen();
    void
    restore_lumen();
    void
    save_lumen(SnapshotData<dim> &data) const;
    /** What statistics.csv says of the lumen, if there is one. */
    std::optional<LumenState>
    lumen_state() const;
    void
    restore();
    void
    find_typical_stiffness();
    void
    check_resumed_cycle() const; // Step may have changed

    void
    begin();
    /** Runs @p steps; what makes them fail goes into the run's files, too. */
    void
    record_failure(const std::function<void()> &steps);
    void
    finish();
    bool
    must_stop() const;
    void
    step();
    SplineSpace<dim>
    splines();
    void
    tell_of_joined_pieces(const SplineSpace<dim> &space);
    void
    count_pieces(const SplineSpace<dim> &space);
    void
    solve_step(const SplineSpace<dim> &space,
               const RigidModes<dim>  &rigid_modes,
               Equilibrium::Vector    &u);
    void
    try_step(const SplineSpace<dim> &space,
             const RigidModes<dim>  &rigid_modes,
             Equilibrium::Vector    &u);
    void
    solve_balance(const SplineSpace<dim>    &space,
                  const RigidModes<dim>     &rigid_modes,
                  const MaterialPoints<dim> &points,
                  Equilibrium::Vector       &u);
    /** What fills the lumen before the step's own pressure is known. */
    EnclosedContent
    lumen_content(const double volume) const;
    /** Solves the step again with other pressures until the lumen has its
     *  volume. @throws StepFailed if it does not get it */
    Equilibrium::Evaluation
    keep_lumen_volume(const SplineSpace<dim>                         &space,
                      const std::function<Equilibrium::Evaluation()> &solve,
                      MomentumBalance<dim>                           &balance,
                      EnclosedContent                                &content,
                      const Equilibrium::Vector                      &u);
    std::optional<Equilibrium::Vector>
    start_of_step(const SplineSpace<dim> &space,
                  const RigidModes<dim>  &modes) const;
    void
    estimate_condition(MomentumBalance<dim> &balance,
                       const LinearProblem  &linear);
    /** What keeps the step free of unsupported motions. */
    std::vector<Equilibrium::Vector>
    inertia(const SplineSpace<dim> &space, const RigidModes<dim> &modes);
    void
    commit(const SplineSpace<dim> &space, const Equilibrium::Vector &u);
    /** Gives cells the steady fields of the present configuration. */
    void
    set_steady_fields(const SplineSpace<dim> &space);
    /** The other fields at the end of the step. */
    FieldsOfStep<dim>
    transient_fields(const SplineSpace<dim> &space);
    /** Those of a kind, at @p t1. */
    FieldsOfStep<dim>
    find_fields(const SplineSpace<dim> &space,
                const FieldKind         kind,
                const double            t1);
    void
    tell_of_fields(const FieldsOfStep<dim> &found);
    /** What statistics.csv says of the fields. */
    std::vector<FieldStatistics>
    field_statistics() const;
    void
    refine_surface(const std::function<bool(const Point<dim> &)> &crowded);
    /** @param former points before the step lost any, where the scene renews
     *  the surface */
    void
    refine_stretched_surface(const SplineSpace<dim> &space,
                             const PointList<dim>   &former);
    bool
    renews_surface() const;
    /** Where it is time, or the step has lost points. @param dt day */
    void
    renew_surface(const PointList<dim> &former, const double dt);
    /** Whether that can be done. Collective. */
    bool
    make_surface_anew(const PointList<dim> &former);
    void
    divide();
    void
    remove_the_dead();
    void
    write_rows();
    void
    write_condition();

    /** Adds the terms of the conditions that load the surface. @throws
     *  StepFailed on all ranks where a condition finds the step too long */
    void
    add_loads(const SplineSpace<dim>                  &space,
              typename MomentumBalance<dim>::TermList &list);
    /** For pieces that loads only push. */
    std::unique_ptr<Term<dim>>
    drag(const SplineSpace<dim> &space) const;

    typename MomentumBalance<dim>::TermList
    terms(const MaterialPoints<dim> &points, const SplineSpace<dim> &space);
    std::vector<typename RigidModes<dim>::Mass>
    masses(const SplineSpace<dim> &space) const;
    RigidModes<dim>
    rigid_modes(const SplineSpace<dim> &space) const;

    StatisticsRow
    statistics() const;
    void
    begin_rows();
    void
    complete_row(const SplineSpace<dim> &space);
    void
    warn_of_long_cells();
    SnapshotData<dim>
    snapshot() const;
    void
    output(const bool last);
    void
    stop_if_asked(const StopSignals &signals); // StoppedBySignal
    /** The longest that the present attempt asks for, µm. Collective. */
    double
    way_of_held_points() const;
    [[noreturn]] void
    give_up(const std::string &reason);
    [[noreturn]] void
    give_up_step(const std::string &reason);

    /** Number of the cell's type. */
    unsigned int
    type_of(const CellView<dim, const double> &cell) const;
    /** Cell number p of the present state. */
    PresentCell<dim>
    present_cell(const unsigned int p, const CellReader<dim> &reader) const;
    /** At the size checkpoint, now. */
    bool
    is_held(const PresentCell<dim> &cell) const;

    const Scene    scene;
    const MPI_Comm comm;
    const Timer    clock;
    TimerOutput    timer;

    const TissueMaterial                                material;
    const BoundaryConditions<dim>                       boundary_conditions;
    const CellDevelopment<dim>                          development;
    const Fields<dim>                                   fields;
    const std::vector<std::unique_ptr<const Fate<dim>>> fates;
    const std::vector<typename SceneEffects<dim>::NamedForce> forces;
    double typical_stiffness = 0.; // kPa

    Tissue<dim>           tissue;
    TimeSteps             time_steps;
    types::particle_index next_id          = 0; // of cells
    types::particle_index next_boundary_id = 0; // where the surface is refined
    unsigned int          n_steps          = 0;
    unsigned int          n_rejected       = 0;

    // Of a lumen.
    double lumen_at_start = 0.; // µm^dim, at t = 0
    double lumen_pressure = 0.; // kPa

    // Of the present step.
    double                           lumen_pressure_of_step = 0.; // kPa
    GrowthOfStep<dim>                growth_of_step;
    std::vector<Birth<dim>>          births; // on this rank
    std::vector<CellEvent>           events; // likewise
    NewtonReport                     newton_report;
    StatisticsRow                    row;
    std::optional<ConditionEstimate> condition; // if the scene asks for it
    std::vector<std::uint64_t>       clipped;   // by field

    PieceWatch<dim> piece_watch;
    bool            pieces_have_joined = false; // and the user knows
    unsigned int    n_pieces           = 0;     // counted if cells die
    bool            pieces_have_parted = false; // and so on

    bool warned_of_long_cells = false; // once a run, or before it started
    bool warned_of_fields     = false; // that did not converge

    std::vector<std::string>         warnings;      // of a new run
    std::optional<SplineSpace<dim>>  first_splines; // until the first step
    std::optional<FieldSolver<dim>>  field_solver;  // of the configuration
    std::optional<SnapshotData<dim>> resumed_from;  // until run()
    std::optional<RunFiles<dim>>     files;         // from run() on
  };
} // namespace Morula

#endif
