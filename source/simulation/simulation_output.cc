// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/simulation.h>
#include <morula/simulation/step_checks.h>
#include <morula/simulation/tissue_tables.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

// What a run tells of its state.

namespace Morula
{
  namespace
  {
    /** A warning of forces at @p t (day) that the weak drag of scenes with
     *  obstacles balances, doc/theory.md (4.8f); nothing where they balance.
     *  @param least what counts as a force, kPa µm^(dim-1) */
    std::optional<std::string>
    balance_warning(const std::vector<ForceRow> &rows,
                    const double                 t,
                    const double                 least)
    {
      // What acts between bodies of the tissue has no part in the sum.
      // A hundredth is more than Newton's method and patches leave.
      constexpr double largest_rest = 0.01;
      Tensor<1, 3>     sum;
      double           magnitude = 0.;
      for (const ForceRow &row : rows)
        if (!row.is_internal)
          {
            sum += row.force;
            magnitude += row.force.norm();
          }
      if (!(sum.norm() > std::max(least, largest_rest * magnitude)))
        return {};
      std::ostringstream text;
      text
        << "Warning: at t = " << t
        << " day the forces on the tissue add up to (" << sum
        << ") kPa um^2 (2-D: kPa um), " << sum.norm() / magnitude
        << " of their sizes: what is left, the weak drag (4.8f) balances, so "
           "the tissue, or a piece of it, drifts until an obstacle stops it. "
           "Hold it by Fixed where or Slip where, or give it Friction. Later "
           "times are not told of.";
      return text.str();
    }
  } // namespace


  template <int dim>
  CellQuantities
  Simulation<dim>::quantities(const unsigned int p) const
  {
    // The reader evaluates expressions of the cells with the present time.
    const CellReader<dim> reader = model.development.reader(time_steps.time());
    return present_cell(tissue, p, reader).quantities();
  }

  template <int dim>
  void
  Simulation<dim>::count(const SplineSpace<dim> &space)
  {
    row.active_grid_cells = space.n_active_grid_cells();
    row.inner_splines     = space.n_inner_splines();
    row.outer_splines     = space.n_outer_splines();
    row.unknowns          = dim * space.n_unknowns();
  }

  template <int dim>
  void
  Simulation<dim>::describe_state()
  {
    // set_state() sums over the cells of all ranks and clears the columns of
    // the effects. The loop fills these columns from two sources: events, which
    // are counted over all ranks, and numbers of the step, which are equal on
    // all ranks already.
    row.step = run_state.n_steps;
    set_state(model, tissue, time_steps.time(), row);
    if (model.development.is_mortal())
      of_step["pieces"] = watches.n_pieces();
    const CellReader<dim> reader = model.development.reader(time_steps.time());
    for (const auto &[name, effect] : model.moments)
      effect->describe(
        tissue, {time_steps.time(), 0., reader, run_state.kept, of_step});
    for (const auto &equation : equations)
      equation->describe(tissue, of_step);
    for (const auto &column : model.tables.columns())
      {
        if (column.counted)
          row.of_effect(column.name) = count(*column.counted);
        if (const auto value = of_step.find(column.name);
            value != of_step.end())
          row.of_effect(column.name) = value->second;
      }
    if (surface.exists())
      row.surface = surface_fit(tissue);
    if (model.development.states_error() && !row.step_error)
      // No step has led to the first row, but the column exists from it on.
      row.step_error = 0.;
  }

  template <int dim>
  void
  Simulation<dim>::warn_of_turn(const DisplacementField<dim> &displacement)
  {
    // Steps in which tissue snaps take many iterations. So others are not
    // looked at, which costs nothing then.
    constexpr unsigned int many_iterations = 15;
    if (told_of_turn || tissue.cells().has_parts() ||
        newton_report.newton_iterations < many_iterations ||
        !turns_too_far(tissue, displacement))
      return;
    told_of_turn = true;
    files->message(turn_message(time_steps.time()));
  }


  template <int dim>
  void
  Simulation<dim>::complete_row()
  {
    // The row joins the state at the end of the step with the work that
    // Newton's method had in all attempts. The messages are given once a run;
    // what they depend on is equal on all ranks, as message() is collective.
    const TimerOutput::Scope section(timer, "statistics");
    describe_state();
    row.newton_iterations = newton_report.newton_iterations;
    row.linear_iterations = newton_report.linear_iterations;
    row.turns             = newton_report.turns;
    row.proximal_paths    = newton_report.proximal_paths;
    row.residual          = newton_report.residual;
    if (row.proximal_paths > 0 && !told_of_path)
      {
        told_of_path = true;
        files->message(path_message(time_steps.time()));
      }
    if (row.lengths.n_too_long > 0 && !warned_of_long_cells)
      {
        warned_of_long_cells = true;
        files->message(long_cells_warning<dim>(row,
                                               model.scene.grid.spacing,
                                               model.scene.has_growth() &&
                                                 !model.development.divides()));
      }
    if (surface_misfits() && !warned_of_misfit)
      {
        warned_of_misfit = true;
        files->message(misfit_warning(row, *run_state.enclosed_share));
      }
  }

  template <int dim>
  std::uint64_t
  Simulation<dim>::count(const EventKind &kind) const
  {
    // Each rank holds the events of its own cells.
    const std::uint64_t n =
      std::count_if(events.begin(), events.end(), [&kind](const auto &event) {
        return event.kind == kind;
      });
    return Utilities::MPI::sum(n, comm);
  }

  template <int dim>
  bool
  Simulation<dim>::surface_misfits() const
  {
    // Loads on the surface and fields that enter through it are wrong by as
    // much as the surface misfits. The user is told from 5 % on.
    return run_state.enclosed_share && row.cells > 0 &&
           std::abs(row.surface->share() / *run_state.enclosed_share - 1.) >
             0.05;
  }

  template <int dim>
  void
  Simulation<dim>::write_rows()
  {
    // The rows of one step go to all tables together: a snapshot counts the
    // rows of each, and a resumed run cuts them there.
    const TimerOutput::Scope section(timer, "rows");
    files->step(row, births, events);
    if (condition)
      files->condition(run_state.n_steps, row.time - row.dt, *condition);
    // There is one row a step. The next step makes an estimate of its own only
    // if it finds none.
    condition.reset();
    if (model.scene.output.newton_trace)
      files->newton(run_state.n_steps, newton_report.trace);
  }

  template <int dim>
  void
  Simulation<dim>::output(const bool last)
  {
    // The snapshot comes last: it waits for the files of points and counts the
    // rows of the tables, so that they belong to it.
    const double t = time_steps.time();
    if (files->writes_points() && files->output_due(t, last))
      {
        const TimerOutput::Scope section(timer, "output");
        files->write_points(cell_table(model, tissue, t).fields(),
                            surface_table(tissue, t).fields(),
                            t);
      }
    if (!forces.empty() && files->forces_due(t, last))
      {
        files->forces(t, forces);
        if (const auto warning =
              balance_warning(forces,
                              t,
                              1e-6 * typical_stiffness *
                                std::pow(model.scene.grid.spacing.value(),
                                         dim - 1));
            warning && model.boundary_conditions.has_pushing() &&
            !warned_of_drift)
          {
            warned_of_drift = true;
            files->message(*warning);
          }
      }
    if (files->snapshot_due(t, last))
      files->write_snapshot(snapshot(), timer);
  }

  template <int dim>
  SnapshotData<dim>
  Simulation<dim>::snapshot() const
  {
    // Boundary points get new ids where patches are split or made anew.
    return snapshot_of(tissue,
                       time_steps.state(),
                       run_state,
                       model.scene.tissue.refine_surface ||
                         model.scene.flows());
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
