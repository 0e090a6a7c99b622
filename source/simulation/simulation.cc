// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/division/divide.h>
#include <morula/effects/fate/removal.h>
#include <morula/particles/detached_points.h>
#include <morula/particles/surface_coarsening.h>
#include <morula/particles/surface_refinement.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <iostream>
#include <new>
#include <sstream>

namespace Morula
{
  template <int dim>
  void
  Simulation<dim>::run(const std::function<void()> &observe)
  {
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
    const StopSignals signals(comm);
    record_failure([&]() {
      if (observe)
        observe();
      while (!must_stop())
        {
          stop_if_asked(signals);
          step();
          write_rows();
          write_condition();
          output(must_stop());
          if (observe)
            observe();
        }
    });
    finish();
  }

  template <int dim>
  void
  Simulation<dim>::begin()
  {
    files.emplace(scene, resumed_from, clock, comm);
    if (!resumed_from)
      {
        for (const std::string &warning : warnings)
          files->message(warning);
        begin_rows();
        write_rows();
        output(must_stop());
      }
    resumed_from.reset();
    warned_of_long_cells = row.lengths.n_too_long > 0;
  }

  template <int dim>
  void
  Simulation<dim>::record_failure(const std::function<void()> &steps)
  {
    try
      {
        steps();
      }
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
        // Also an expression without a value at some later time: the scene had
        // been accepted, so this is no longer bad input but a run that failed.
        std::ostringstream text;
        text << "At t = " << time_steps.time() << " day: " << error.what();
        files->fail(text.str());
        throw std::runtime_error(text.str());
      }
  }

  template <int dim>
  void
  Simulation<dim>::finish()
  {
    files->write_timings(timer);
    files->finish(row.cells == 0        ? "Finished: all cells are dead" :
                  time_steps.finished() ? "Finished: End time reached" :
                                          "Finished: Stop at cells reached",
                  row,
                  n_rejected,
                  timer);
  }

  template <int dim>
  const Tissue<dim> &
  Simulation<dim>::state() const
  {
    return tissue;
  }

  template <int dim>
  const StatisticsRow &
  Simulation<dim>::last_row() const
  {
    return row;
  }

  template <int dim>
  bool
  Simulation<dim>::must_stop() const
  {
    if (time_steps.finished())
      return true;
    if (scene.time.stop_at_cells == 0 && !scene.has_death())
      return false;
    const auto n_cells =
      Utilities::MPI::sum<std::uint64_t>(tissue.cells().size(), comm);
    return n_cells == 0 || (scene.time.stop_at_cells > 0 &&
                            n_cells >= scene.time.stop_at_cells);
  }

  template <int dim>
  void
  Simulation<dim>::step()
  {
    row           = StatisticsRow();
    newton_report = NewtonReport();
    births        = {};
    events        = {};
    condition.reset();
    ++n_steps;

    clipped.clear();
    const SplineSpace<dim> space = splines();
    tell_of_joined_pieces(space);
    solve_steady_fields(space);
    const RigidModes<dim> modes = rigid_modes(space);
    Equilibrium::Vector   u;
    solve_step(space, modes, u);
    commit(space, u);
    {
      const TimerOutput::Scope section(timer, "strays");
      pull_back_detached_points(tissue);
    }

    row.dt = time_steps.next() - time_steps.time();
    time_steps.accept();
    divide();
    remove_the_dead();
    refine_stretched_surface(space);
    complete_row(space);
  }

  template <int dim>
  SplineSpace<dim>
  Simulation<dim>::splines()
  {
    if (first_splines)
      {
        // The cells are where they were when the first row was written.
        SplineSpace<dim> space = std::move(*first_splines);
        first_splines.reset();
        return space;
      }
    const TimerOutput::Scope section(timer, "grid");
    tissue.defragment(); // here, where a step holds least memory
    return tissue.splines(material.volumetric_form() !=
                          VolumetricStrain::pointwise);
  }

  template <int dim>
  void
  Simulation<dim>::tell_of_joined_pieces(const SplineSpace<dim> &space)
  {
    const std::optional<Point<dim>> place = piece_watch.joined(space);
    if (!place || pieces_have_joined)
      return;
    pieces_have_joined = true;
    std::ostringstream text;
    text << "Warning: at t = " << time_steps.time()
         << " day two parts of the tissue have come within a grid spacing of "
         << "each other near (" << *place << ") um. From now on they stick "
         << "together there, though their cells may not touch yet "
         << "(doc/faq.md, bodies that stick). A smaller Grid/Spacing lets them "
         << "come closer. Later ones are not told of.";
    files->message(text.str());
  }

  template <int dim>
  void
  Simulation<dim>::solve_step(const SplineSpace<dim> &space,
                              const RigidModes<dim>  &rigid_modes,
                              Equilibrium::Vector    &u)
  {
    while (true)
      try
        {
          try_step(space, rigid_modes, u);
          return;
        }
      catch (const StepFailed &failure)
        {
          ++row.rejected_steps;
          ++n_rejected;
          if (!time_steps.reject())
            give_up_step(failure.what());
        }
      catch (const InputError &error)
        {
          // an expression without a value at this time
          give_up(scene.located(error.what()));
        }
  }

  template <int dim>
  void
  Simulation<dim>::write_rows()
  {
    const TimerOutput::Scope section(timer, "rows");
    files->step(row, births, events);
  }

  template <int dim>
  void
  Simulation<dim>::write_condition()
  {
    if (condition)
      files->condition(n_steps, row.time - row.dt, *condition);
  }

  template <int dim>
  void
  Simulation<dim>::refine_surface(
    const std::function<bool(const Point<dim> &)> &crowded)
  {
    if (!scene.tissue.refine_surface)
      return;
    const TimerOutput::Scope section(timer, "surface refinement");
    PointList<dim>           points       = tissue.boundary_points().copy();
    const auto              &columns      = tissue.boundary_points().columns();
    const double             longest_edge = 0.5 * scene.grid.spacing;
    const bool               has_merged   = scene.tissue.coarsen_surface &&
                            coarsen_surface<dim>(
                              points,
                              columns,
                              longest_edge,
                              [this](const auto &a, const auto &b) {
                                return boundary_conditions.alike(a, b);
                              },
                              comm);
    const bool has_split = Morula::refine_surface(
      points, columns, longest_edge, crowded, next_boundary_id, comm);
    if (has_merged || has_split)
      tissue.replace_surface(points);
  }

  template <int dim>
  void
  Simulation<dim>::refine_stretched_surface(const SplineSpace<dim> &space)
  {
    try
      {
        refine_surface([&space](const Point<dim> &x) {
          return space.occupancy().crowded(x);
        });
      }
    catch (const SurfaceTorn &error)
      {
        // This step is done; the next one could not be.
        complete_row(space);
        write_rows();
        ++n_steps;
        give_up(error.what() + std::string("."));
      }
  }

  template <int dim>
  void
  Simulation<dim>::divide()
  {
    if (development.cycle() == nullptr)
      return;
    const TimerOutput::Scope        section(timer, "division");
    const std::vector<unsigned int> due =
      cells_due(tissue, development, time_steps.time());
    row.dividing = Utilities::MPI::sum<std::uint64_t>(due.size(), comm);
    if (row.dividing > 0)
      {
        Divisions<dim> divisions =
          Morula::divide(tissue, development, due, time_steps.time(), next_id);
        births = std::move(divisions.births);
        events.insert(events.end(),
                      divisions.events.begin(),
                      divisions.events.end());
      }
  }

  template <int dim>
  void
  Simulation<dim>::remove_the_dead()
  {
    if (!scene.has_death())
      return;
    const TimerOutput::Scope section(timer, "removal");
    const std::uint64_t      n_deaths =
      std::count_if(events.begin(), events.end(), [](const CellEvent &event) {
        return event.kind == CellEvent::Kind::death;
      });
    const std::vector<CellEvent> removals =
      remove_dead_cells(tissue, development, time_steps.time());
    events.insert(events.end(), removals.begin(), removals.end());
    row.death.emplace();
    row.death->deaths = Utilities::MPI::sum(n_deaths, comm);
    row.death->removed =
      Utilities::MPI::sum<std::uint64_t>(removals.size(), comm);
  }

  template <int dim>
  unsigned int
  Simulation<dim>::n_unknowns()
  {
    return dim * splines().n_unknowns();
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
