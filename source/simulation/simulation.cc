// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/effects/division/divide.h>
#include <morula/effects/fate/removal.h>
#include <morula/effects/surface/carriers.h>
#include <morula/particles/detached_points.h>
#include <morula/particles/surface_refinement.h>
#include <morula/simulation/simulation.h>
#include <morula/simulation/step_supports.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <set>

// One step.

namespace Morula
{
  namespace
  {
    /** A step that is plainly too long is halved so often before a proximal
     * path is tried. An eighth of it hardly is too long any more: then
     * something jumps. */
    constexpr unsigned int most_plain_halves = 3;


    /** Whether a condition has killed cells that are gone already. */
    bool
    cuts(const std::vector<CellEvent> &events)
    {
      std::set<types::particle_index> killed;
      for (const CellEvent &event : events)
        if (event.at_once)
          killed.insert(event.id);
      return std::any_of(events.begin(), events.end(), [&](const auto &event) {
        return event.kind == CellEvent::removal && killed.count(event.id) > 0;
      });
    }
  } // namespace


  template <int dim>
  void
  Simulation<dim>::step()
  {
    row                       = StatisticsRow();
    newton_report             = NewtonReport();
    newton_report.wants_trace = model.scene.output.newton_trace;
    of_step                   = {};
    births                    = {};
    events                    = {};
    ++run_state.n_steps;
    fields.begin_step();

    const SplineSpace<dim> space = splines();
    pieces.look(space, tissue.grid(), time_steps.time());
    gaps.look(tissue, space, time_steps.time());
    // Those of t = 0 stand in the first row.
    if (run_state.n_steps > 1)
      find_fields(
        [&]() { fields.set_steady(tissue, space, time_steps.time()); });
    for_step_effects(&StepEffect<dim>::before, time_steps.time(), 0.);
    adapt_step();
    const auto   solution = solve_step(space);
    const double mu       = error_of_step(growth_of_step.missed_growth);
    commit(space, solution);
    if (model.development.states_error())
      {
        row.step_error = mu;
        run_state.error.add(mu);
      }
    if (!surface.restores(run_state.enclosed_share))
      {
        const TimerOutput::Scope section(timer, "strays");
        pull_back_detached_points(tissue);
      }

    row.dt = time_steps.next() - time_steps.time();
    time_steps.accept();
    divide();
    const PointList<dim> former = surface.before_losses(tissue);
    remove_the_dead();
    count(space);
    follow_surface(space, former);
    renew_carriers(tissue);
    for_step_effects(&StepEffect<dim>::after, time_steps.time(), row.dt);
    complete_row();
  }

  template <int dim>
  void
  Simulation<dim>::for_step_effects(const MomentOfStep moment,
                                    const double       t,
                                    const double       dt)
  {
    for (const auto &[name, effect] : model.step_effects)
      {
        const TimerOutput::Scope section(timer, name);
        const CellReader<dim>    reader = model.development.reader(t);
        (*effect.*moment)(tissue, {t, dt, reader, run_state.kept, of_step});
      }
  }

  template <int dim>
  void
  Simulation<dim>::adapt_step()
  {
    if (model.scene.time.tolerance <= 0.)
      return;
    const TimerOutput::Scope section(timer, "growth");
    std::vector<double>      missed;
    everywhere(comm, [&]() {
      missed = model.development.missed_growth(tissue,
                                               time_steps.time(),
                                               time_steps.past());
    });
    time_steps.adapt(error_of_step(missed));
  }

  template <int dim>
  double
  Simulation<dim>::error_of_step(const std::vector<double> &missed) const
  {
    if (!model.development.states_error())
      return 0.;
    return run_state.error.flow +
           mean_over_tissue<dim>(
             tissue,
             [&](const unsigned int p) {
               return missed.empty() ? 0. : missed[p];
             },
             std::pow(model.scene.tissue.cell_spacing, dim));
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
    return tissue.splines(model.material.volumetric_form() !=
                          VolumetricStrain::pointwise);
  }

  template <int dim>
  typename StepEquilibrium<dim>::Solution
  Simulation<dim>::solve_step(const SplineSpace<dim> &space)
  {
    try
      {
        typename StepEquilibrium<dim>::Supports supports;
        everywhere(comm, [&]() {
          supports = step_supports(
            model, tissue, space, time_steps.time(), time_steps.next());
        });
        const StepEquilibrium<dim> equilibrium(
          model, tissue, space, supports, timer, comm);
        while (true)
          try
            {
              newton_report.first_residual = newton_report.curvature = 0.;
              return try_step(equilibrium);
            }
          catch (const StepFailed &failure)
            {
              if (row.rejected_steps == 0)
                first_attempt = {time_steps.next() - time_steps.time(),
                                 newton_report.first_residual};
              ++row.rejected_steps;
              ++run_state.n_rejected;
              ++newton_report.place.attempt;
              if (!time_steps.reject())
                give_up_step(failure.what());
            }
      }
    catch (const InputError &error)
      {
        // an expression without a value at this time
        give_up(model.scene.located(error.what()));
      }
  }

  template <int dim>
  typename StepEquilibrium<dim>::Solution
  Simulation<dim>::try_step(const StepEquilibrium<dim> &equilibrium)
  {
    const double t = time_steps.time(), t_next = time_steps.next();
    if (model.development.present())
      {
        const TimerOutput::Scope section(timer, "growth");
        everywhere(comm, [&]() {
          growth_of_step =
            model.development.of_step(tissue, t, t_next, time_steps.past());
        });
        // Of the step's cells, so that a resumed run has the same.
        if (model.material.depends_on_state())
          typical_stiffness =
            model.typical_stiffness(tissue, growth_of_step, comm);
      }
    return equilibrium.solve({t,
                              t_next,
                              growth_of_step,
                              typical_stiffness,
                              saved_lumen(model, run_state.kept),
                              time_steps.can_halve() &&
                                time_steps.state().level < most_plain_halves},
                             newton_report,
                             condition);
  }

  template <int dim>
  void
  Simulation<dim>::find_fields(const std::function<void()> &find)
  {
    const bool has_begun = run_state.n_steps > 0;
    try
      {
        find();
      }
    catch (const InputError &error)
      {
        if (!has_begun)
          throw;
        give_up(model.scene.located(error.what()));
      }
    catch (const StepFailed &failure)
      {
        const std::string reason = failure.what() + std::string(".");
        if (!has_begun)
          throw std::runtime_error(reason);
        give_up(reason);
      }
  }

  template <int dim>
  void
  Simulation<dim>::divide()
  {
    if (model.development.cycle() == nullptr)
      return;
    const TimerOutput::Scope        section(timer, "division");
    const std::vector<unsigned int> due =
      cells_due(tissue, model.development, time_steps.time());
    row.dividing = Utilities::MPI::sum<std::uint64_t>(due.size(), comm);
    if (row.dividing > 0)
      {
        Divisions<dim> divisions = Morula::divide(
          tissue, model.development, due, time_steps.time(), run_state.next_id);
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
    if (!model.development.is_mortal())
      return;
    const TimerOutput::Scope section(timer, "removal");
    const auto               n_points = [&]() {
      return Utilities::MPI::sum<std::uint64_t>(tissue.boundary_points().size(),
                                                comm);
    };
    const std::uint64_t          n_before = n_points();
    const std::vector<CellEvent> removals = remove_dead_cells(
      tissue, model.development, time_steps.time(), model.fields.carried());
    events.insert(events.end(), removals.begin(), removals.end());
    // The surface is open where it was cut, unless it is made anew.
    if (surface.is_cut(n_before, n_points()))
      run_state.enclosed_share.reset();
    if (Utilities::MPI::logical_or(cuts(events), comm))
      time_steps.begin_anew();
  }

  template <int dim>
  void
  Simulation<dim>::follow_surface(const SplineSpace<dim> &space,
                                  const PointList<dim>   &former)
  {
    try
      {
        surface.follow(tissue,
                       space,
                       former,
                       run_state.enclosed_share,
                       time_steps.time(),
                       row.dt);
      }
    catch (const SurfaceTorn &error)
      {
        // This step is done; the next one could not be.
        complete_row();
        write_rows();
        ++run_state.n_steps;
        give_up(error.what() + std::string("."));
      }
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
