// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/fate/removal.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/seeding/bodies.h>
#include <morula/simulation/simulation.h>
#include <morula/simulation/snapshot_check.h>
#include <morula/solver/linear_solver.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <iostream>
#include <new>
#include <sstream>

// How a run begins, goes on and ends.

namespace Morula
{
  namespace
  {
    /** The points that this rank makes at t = 0, with all columns that effects
     *  need. They may lie in grid cells of other ranks. */
    template <int dim>
    struct FirstPoints
    {
      PointList<dim> cells, boundary_points;
      /** The founders' rows in lineage.csv. */
      std::vector<Birth<dim>> births;
    };

    /** Gives founders and patches the state in which they begin. Collective.
     *  @throws InputError on all ranks if an effect cannot handle a founder */
    template <int dim>
    FirstPoints<dim>
    found(const TissueModel<dim>  &model,
          const SeededTissue<dim> &seeded,
          const MPI_Comm           comm)
    {
      // Founders come first, as an effect may refuse one of them; patches
      // cannot fail. Each rank has a part of both, numbered from first_id on,
      // so that ids do not depend on who has which part. The points may lie
      // anywhere: Tissue::place() sends them to the owners of their grid cells
      // later.
      const Founders<dim>       &founders = seeded.founders;
      const SurfacePatches<dim> &patches  = seeded.surface;
      const BoundaryColumns<dim> boundary = model.boundary_columns();
      FirstPoints<dim>           points{PointList<dim>(
                                model.development.columns().n_numbers()),
                              PointList<dim>(boundary.n_numbers()),
                                        {}};
      points.cells.reserve(founders.positions.size());
      points.births.reserve(founders.positions.size());
      // The row of a founder is complete before any effect sees it: an effect
      // checks the cell that will be in the first step, and refuses what it
      // cannot handle. The founder is added to the cells and to lineage.csv,
      // where it has no mother (-1).
      const double step = model.scene.time.step;
      for_first_cells<dim>(
        model,
        founders,
        patches,
        step,
        comm,
        [&](const std::size_t       i,
            std::vector<double>    &row,
            const PresentCell<dim> &founder) {
          for (const auto &named : model.equations)
            named.effect->check_cell(founder, step);
          for (const auto &trait : model.traits)
            trait->check_cell(founder, step);
          for (const auto &named : model.step_effects)
            named.effect->check_cell(founder, step);
          for (const auto &named : model.forces)
            named.effect->check_cell(founder, step);
          const Point<dim> X = founders.positions[i];
          points.cells.add(founder.id(), X, make_array_view(row));
          points.births.push_back(
            {founder.id(),
             -1,
             founders.generations.empty() ? 0 : founders.generations[i],
             0.,
             X,
             founder.type(),
             model.development.state().named_numbers(&founder.cell())});
        });
      for (std::size_t i = 0; i < patches.positions.size(); ++i)
        {
          // The condition of a patch is decided here, once for the whole run:
          // it depends on the initial position and normal only.
          const Point<dim>     X   = patches.positions[i];
          const Tensor<1, dim> N   = patches.normals[i];
          std::vector<double>  row = boundary.initial_point(
            X, N, patches.areas[i], model.boundary_conditions.condition(X, N));
          if (boundary.body.exists())
            boundary.body.set(make_array_view(row), patches.bodies.at(i));
          points.boundary_points.add(patches.first_id + i,
                                     X,
                                     make_array_view(row));
        }
      return points;
    }
  } // namespace


  template <int dim>
  Simulation<dim>::Simulation(const Scene &scene, const MPI_Comm comm)
    : model(scene)
    , comm(comm)
    , timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
    , tissue(model.empty_tissue(comm))
    , time_steps(scene.time)
    , watches(model, [this](const std::string &text) { files->message(text); })
    , surface(model, run_state, timer, comm)
  {
    for (const auto &[name, equation] : model.equations)
      equations.push_back(equation->in_run(
        {[this](const double t) { return model.development.reader(t); },
         make_linear_solvers(model.scene.solver),
         timer,
         [this](const std::string &text) { files->message(text); }}));
  }

  template <int dim>
  Simulation<dim>::Simulation(const Scene   &scene,
                              const MPI_Comm comm,
                              const bool     resume)
    : Simulation(scene, comm)
  {
    const TimerOutput::Scope section(timer, "seeding");
    if (resume)
      restore();
    else
      seed(seed_tissue(model, comm));
  }

  template <int dim>
  Simulation<dim>::Simulation(const Scene             &scene,
                              const MPI_Comm           comm,
                              const SeededTissue<dim> &seeded)
    : Simulation(scene, comm)
  {
    const TimerOutput::Scope section(timer, "seeding");
    seed(seeded);
  }

  template <int dim>
  void
  Simulation<dim>::seed(const SeededTissue<dim> &seeded)
  {
    // The cells and boundary points get their first state and then their ranks:
    // place() makes the grid and sends points to the owners of their grid
    // cells. The surface is refined before anything is measured on it: the
    // carriers of held points belong to the refined points. No file is touched,
    // as begin() opens them.
    FirstPoints<dim> points = found(model, seeded, comm);
    tissue.place(std::move(points.cells), std::move(points.boundary_points));
    births = std::move(points.births);
    phases_are_given =
      Utilities::MPI::max<int>(!seeded.founders.phases.empty(), comm) > 0;
    warnings = {"Method: " + method_text(model.scene),
                "Material: " + material_text(model.scene)};
    for (const auto &[name, text] : seeded.applied)
      warnings.push_back("Applied: " + name + " at " + text);
    if (!seeded.mesh.empty())
      warnings.push_back("Surface mesh: " + seeded.mesh);
    if (!seeded.cuts.empty())
      warnings.push_back("Cut: " + seeded.cuts);
    for (const std::string &text : seeded.pieces)
      warnings.push_back("Connected tissue: " + text);
    warnings.insert(warnings.end(),
                    seeded.warnings.begin(),
                    seeded.warnings.end());
    run_state.kept             = model.tables.kept();
    run_state.next_id          = seeded.founders.n_global;
    run_state.next_boundary_id = seeded.surface.n_global;
    if (surface.exists())
      surface.begin(tissue);
    renew_carriers(tissue);
    for_moments(&Moments<dim>::surfaced, 0., 0.);
    typical_stiffness = model.typical_stiffness(tissue, growth_of_step, comm);
  }

  template <int dim>
  void
  Simulation<dim>::restore()
  {
    // All checks come before the tissue is filled: a snapshot of another scene,
    // or with other columns, is refused with its key. The run's numbers and the
    // place in the sequence of steps are restored before the tissue, whose
    // points are moved out of the snapshot. The state is then described, so
    // that last_row() is right before the first step.
    const std::string path = model.scene.output_directory + "/snapshot.h5";
    check_resumable(model.scene, read_snapshot_parameters(path, comm));
    resumed_from = read_snapshot<dim>(path, comm);
    check_columns(*resumed_from,
                  tissue.cells().columns(),
                  tissue.boundary_points().columns(),
                  comm);
    const auto saved = saved_state(*resumed_from, model.tables.kept());
    run_state        = saved.second;
    time_steps.restore(saved.first);
    restore_tissue(*resumed_from, tissue);
    surface.resume(tissue);
    typical_stiffness = model.typical_stiffness(tissue, growth_of_step, comm);
    describe_state();
    if (model.development.cycle() == nullptr)
      return;
    // A resumed run may have another Time/Step, with which a phase of the cycle
    // can be too short for a step. Each rank checks the cells that it owns.
    std::vector<Point<dim>> founders;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      founders.push_back(tissue.cells()[p].founder_position());
    everywhere(comm, [&]() {
      model.development.cycle()->check(founders, model.scene.time.step);
    });
  }

  template <int dim>
  void
  Simulation<dim>::run(const std::function<void()> &observe)
  {
    // begin() opens the files and writes the first rows, so a run that has
    // ended already must not reach it. Signals are recorded from then on, as
    // there is something to save. Failures inside the loop also go to log.txt.
    // A step is complete when its rows are written: output() may write a
    // snapshot that counts them.
    if (resumed_from && must_stop())
      {
        if (Utilities::MPI::this_mpi_process(comm) == 0)
          std::cout << "Already finished at t = " << time_steps.time()
                    << " day: nothing to resume.\n";
        if (observe)
          observe();
        return;
      }
    begin();
    signals.emplace(comm);
    try
      {
        if (observe)
          observe();
        while (!must_stop())
          {
            begun = {time_steps.state(), run_state, {}};
            stop_if_asked();
            step();
            write_rows();
            output(must_stop());
            if (observe)
              observe();
          }
      }
    // Memory has run out on this rank alone. The program's main function tells
    // of it and ends all ranks.
    catch (const std::bad_alloc &)
      {
        throw;
      }
    catch (const StoppedBySignal &stop)
      {
        files->fail(stop.what());
        throw;
      }
    catch (const std::exception &error)
      {
        // An expression without a value at some later time arrives here, too:
        // the scene had been accepted, so this is no longer bad input but a run
        // that failed.
        std::ostringstream text;
        text << "At t = " << time_steps.time() << " day: " << error.what();
        files->fail(text.str());
        throw std::runtime_error(text.str());
      }
    files->write_timings(timer);
    files->finish(row.cells == 0        ? "Finished: all cells are dead" :
                  time_steps.finished() ? "Finished: End time reached" :
                                          "Finished: Stop at cells reached",
                  row,
                  run_state.n_rejected);
    signals.reset();
  }

  template <int dim>
  void
  Simulation<dim>::found_again(const bool all)
  {
    // Founders have got their state when no steady field was known yet: their
    // clocks, axes and numbers may depend on one. The type, and the phase if
    // the file has one, stand in the row. The rows of lineage.csv have numbers;
    // they are made while no founder has been carved away.
    const CellReader<dim>    reader      = model.development.reader(0.);
    const Cells<dim>        &cells       = tissue.cells();
    const StateColumns<dim> &state       = model.development.state();
    const bool               has_numbers = !state.named_numbers().empty();
    if (all && has_numbers)
      births.clear();
    everywhere(comm, [&]() {
      for (unsigned int p = 0; p < cells.size(); ++p)
        {
          GivenState given;
          if (state.type.exists())
            given.type = cells[p].get(state.type);
          if (phases_are_given)
            given.phase = reader.phase(cells[p]);
          model.development.initialize(cells.id(p), tissue.cell(p), 0., given);
          const CellView<dim, const double> cell = cells[p];
          if (all && has_numbers)
            births.push_back({cells.id(p),
                              -1,
                              cell.generation(),
                              0.,
                              cells.position(p),
                              given.type.value_or(0),
                              state.named_numbers(&cell)});
        }
    });
  }

  template <int dim>
  void
  Simulation<dim>::begin()
  {
    // A new run still has to make its first row: steady fields are found on the
    // first splines, as carving, the axes of founders and the columns of the
    // row may depend on them. Carving changes the tissue, and the fields with
    // it, so they are found again on new splines, as where the tissue gives way
    // to what acts on it. The splines are kept for the first step, which begins
    // in the same configuration. A resumed run has its rows already.
    files.emplace(model, resumed_from, clock, comm);
    for (const std::string &warning : warnings)
      files->message(warning);
    if (!resumed_from)
      {
        const auto find_steady = [&](const bool all) {
          first_splines.reset();
          first_splines.emplace(splines());
          const std::optional<SplineSpace<dim>> apart =
            splines_of_equations(*first_splines);
          settle_equations(apart ? *apart : *first_splines);
          // Carving or the first step makes the solver anew.
          for (const auto &equation : equations)
            equation->forget_configuration();
          if (std::any_of(model.equations.begin(),
                          model.equations.end(),
                          [](const auto &named) {
                            return named.effect->is_steady();
                          }))
            found_again(all);
        };
        find_steady(true);
        // The fields decide what is carved, and what is left decides the
        // fields.
        if (carve())
          find_steady(false);
        for_moments(&Moments<dim>::settle, time_steps.time(), 0.);
        if (balance_at_start())
          find_steady(false);
        keep_places(); // nothing has strained: no cell moves
        watches.look_at_pieces(*first_splines, comm, time_steps.time());
        count(*first_splines);
        describe_state();
        write_rows();
        output(must_stop());
      }
    resumed_from.reset();
    if (model.development.is_mortal())
      watches.look_at_conditions(tissue, time_steps.time());
    // What holds at the beginning already needs no message from a step on: the
    // user was told of it before the run, or by the run before.
    warned_of_long_cells = row.has_long_cells();
    warned_of_misfit     = surface_misfits();
  }

  template <int dim>
  bool
  Simulation<dim>::carve()
  {
    if (!model.development.is_mortal())
      return false;
    // Removal leaves holes in the surface where boundary points have gone with
    // the cells. The surface is closed first; what is measured on it, or on the
    // cells that are left, is then found again. All ranks go the same way, as
    // the count is that of all.
    PointList<dim> former = surface.before_losses(tissue);
    events                = Morula::carve(tissue, model.development);
    if (count(CellEvent::removal) == 0)
      return false;
    // What stands apart is known when what was between is gone.
    if (model.interaction &&
        !model.interaction->effect->takes_types_as_bodies())
      tell_bodies_apart(tissue, former);
    surface.close_cuts(tissue, former);
    renew_carriers(tissue);
    for_moments(&Moments<dim>::surfaced, 0., 0.);
    typical_stiffness = model.typical_stiffness(tissue, growth_of_step, comm);
    return true;
  }

  template <int dim>
  bool
  Simulation<dim>::must_stop() const
  {
    // The cells are counted over all ranks only where their number can end the
    // run: the sum is a collective call in each step.
    const auto limit = model.scene.time.stop_at_cells;
    if (time_steps.finished())
      return true;
    if (limit == 0 && !model.development.is_mortal())
      return false;
    const auto n_cells =
      Utilities::MPI::sum<std::uint64_t>(tissue.cells().size(), comm);
    return n_cells == 0 || (limit > 0 && n_cells >= limit);
  }

  template <int dim>
  void
  Simulation<dim>::give_up(const std::string &reason)
  {
    // The step was counted when it began, but it is not done. None had begun
    // where the tissue is torn at t = 0.
    run_state.n_steps -= run_state.n_steps > 0;
    files->write_snapshot(snapshot(), timer);
    // These rows follow the snapshot, which must not count them: a resumed run
    // repeats the step and writes its own.
    write_work(run_state.n_steps + 1, time_steps.time());
    files->write_timings(timer);
    throw std::runtime_error(reason + " The state is saved in snapshot.h5.");
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
