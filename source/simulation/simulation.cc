// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/division/divide.h>
#include <morula/effects/fate/removal.h>
#include <morula/particles/detached_points.h>
#include <morula/particles/even_fill.h>
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
    if (scene.time.stop_at_cells == 0 && development.death() == nullptr)
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
    count_pieces(space);
    // Those of t = 0 stand in the first row.
    if (n_steps > 1)
      set_steady_fields(space);
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
    const PointList<dim> former =
      renews_surface() ? tissue.boundary_points().copy() : PointList<dim>();
    remove_the_dead();
    if (renews_surface())
      {
        even_out_fill(tissue,
                      space.occupancy(),
                      std::min(1., row.dt / scene.tissue.renew_surface));
        renew_surface(former, row.dt);
      }
    refine_stretched_surface(space, former);
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
    if (development.death() == nullptr)
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
