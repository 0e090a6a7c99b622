// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/rows.h>
#include <morula/simulation/simulation.h>
#include <morula/simulation/step_checks.h>

#include <sstream>

// What a run tells of its state.

namespace Morula
{
  namespace
  {
    /** Sets the columns of @p row about the tissue at @p t (day); those of the
     *  effects that count events or belong to the step are 0 then. Other
     * columns about the step stay. Collective. */
    template <int dim>
    void
    set_state(const TissueModel<dim> &model,
              const Tissue<dim>      &tissue,
              const double            t,
              StatisticsRow          &row)
    {
      // The first pass goes once through this rank's cells and adds up all that
      // is asked of them, as reading a cell with its stress is the costly part.
      // Boundary points only extend the box around the tissue. The second pass
      // makes sums over all ranks of it. The columns of effects are set anew in
      // the order of the scene.
      const auto           &columns = model.tables.columns();
      const Cells<dim>     &cells   = tissue.cells();
      const CellReader<dim> reader  = model.development.reader(t);
      const MPI_Comm        comm    = tissue.communicator();
      TissueSums<dim>       sums;
      LongestCell<dim>      longest(model.scene.grid.spacing);
      std::vector<double>   of_effects(columns.size(), 0.);
      std::uint64_t         held = 0;
      for (unsigned int p = 0; p < cells.size(); ++p)
        {
          const PresentCell<dim> cell = present_cell(tissue, p, reader);
          sums.add_cell(cell.scalars(), cell.position());
          held += model.development.is_held(cell, t);
          for (std::size_t k = 0; k < columns.size(); ++k)
            // Columns that count events or belong to the step stay 0 here.
            if (columns[k].of_cell)
              of_effects[k] += columns[k].of_cell(cell);
          longest.add(cell.position(), cell_shape<dim>(cell.cell()));
        }
      for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
        sums.add_boundary_point(tissue.boundary_points().position(p));

      row.time    = t;
      row.cells   = Utilities::MPI::sum<std::uint64_t>(cells.size(), comm);
      row.tissue  = sums.totals(comm);
      row.lengths = longest.over_all_ranks(comm);
      row.held_at_checkpoint = Utilities::MPI::sum(held, comm);
      Utilities::MPI::sum(of_effects, comm, of_effects);
      row.of_effects.clear();
      for (std::size_t k = 0; k < columns.size(); ++k)
        row.of_effects.emplace_back(columns[k].name,
                                    columns[k].is_mean ?
                                      of_effects[k] /
                                        std::max<double>(row.cells, 1.) :
                                      of_effects[k]);
    }


    /** The table behind cells-NNNN.csv and .vtu, at @p t, day. */
    template <int dim>
    CellFields<dim>
    cell_table(const TissueModel<dim> &model,
               const Tissue<dim>      &tissue,
               const double            t)
    {
      // The table has this rank's cells in the canonical order (by grid cell,
      // then by id). The output joins those of all ranks.
      const Cells<dim>     &cells = tissue.cells();
      CellFields<dim>       table(t,
                            cells.size(),
                            cells.columns(),
                            model.development.has_checkpoint());
      const CellReader<dim> reader = model.development.reader(t);
      for (unsigned int p = 0; p < cells.size(); ++p)
        {
          const PresentCell<dim> cell = present_cell(tissue, p, reader);
          // A cell's stress and phase are those of this state and not of the
          // step that led to it.
          table.add(cells.id(p),
                    cells[p],
                    cells.position(p),
                    reader.phase(cells[p]),
                    model.development.is_held(cell, t),
                    cell.quantities());
        }
      return table;
    }


    /** The warning about cells that are too long for the grid. */
    template <int dim>
    std::string
    long_cells_warning(const StatisticsRow &row,
                       const double         grid_spacing,
                       const bool           grows_undivided)
    {
      // The row is that of all ranks. The length is the grid spacing over the
      // least number of cells in it, which is how the column is defined
      // (doc/theory.md, section 2.1).
      const auto        &place = row.lengths.place;
      std::ostringstream text;
      text << "Warning: from t = " << row.time << " day on, "
           << row.lengths.n_too_long << " of " << row.cells
           << " cells are longer than half of Grid/Spacing = " << grid_spacing
           << " um, the longest, at (" << place[0] << ' ' << place[1];
      if (dim == 3)
        text << ' ' << place[2];
      text
        << ") um, " << grid_spacing / row.lengths.min_cells_per_spacing
        << " um. Stresses there may be a tenth too low, and if it gets worse "
           "the run may fail; other cells are hardly affected. Start anew with "
           "a smaller Tissue/Cell spacing or a larger Grid/Spacing"
        << (grows_undivided ? ", or with cells that divide when they have "
                              "grown: Division by size/Volume" :
                              "")
        << "; the column min_cells_per_spacing of statistics.csv has the "
           "number.";
      return text.str();
    }


    /** The warning about a surface that does not enclose its cells any more.
     *  @param share_at_start as RunState::enclosed_share */
    std::string
    misfit_warning(const StatisticsRow &row, const double share_at_start)
    {
      std::ostringstream text;
      text
        << "Warning: from t = " << row.time << " day on, the surface encloses "
        << row.surface->share() << " of the cells' volume, and did "
        << share_at_start
        << " at t = 0: boundary points have left the cells, the surface has a "
           "hole, or cells share space. Loads on the surface and fields that "
           "enter through it are wrong by as much. Tissue/Surface = from cells "
           "makes it anew; a smaller Grid/Spacing follows the tissue more "
           "closely. "
           "The columns enclosed_volume, total_volume and surface_distance of "
           "statistics.csv have the numbers.";
      return text.str();
    }


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
            magnitude += std::max(row.force.norm(), std::abs(row.inward));
          }
      if (!(sum.norm() > std::max(least, largest_rest * magnitude)))
        return {};
      std::ostringstream text;
      text
        << "Warning: at t = " << t
        << " day the forces on the tissue add up to (" << sum
        << ") kPa um^2 (2-D: kPa um), " << sum.norm() / magnitude
        << " of their sizes: only a weak drag (4.8f) balances that, so the "
           "tissue, or a part of it, drifts until an obstacle stops it. Fix it "
           "by Fixed where or Slip where, or give it Friction. Further cases "
           "are not reported.";
      return text.str();
    }
  } // namespace


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
      of_step["connected_tissues"] = watches.n_pieces();
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
      row.surface = surface_fit(tissue, row.tissue.total_volume);
    if (model.development.states_error())
      row.step_error = run_state.error.total();
  }

  template <int dim>
  void
  Simulation<dim>::warn_of_turn(const SplineSpace<dim>       &space,
                                const DisplacementField<dim> &displacement)
  {
    // Steps in which tissue snaps take many iterations. So others are not
    // looked at, which costs nothing then.
    constexpr unsigned int many_iterations = 15;
    if (told_of_turn || tissue.cells().has_parts() ||
        newton_report.newton_iterations < many_iterations ||
        !turns_too_far(tissue, space, displacement))
      return;
    told_of_turn = true;
    files->message(
      "Warning: at t = " + as_text(time_steps.time()) +
      " day a strand of tissue turns by more than 36 degrees within a step. It "
      "may pass through itself there, as surfaces without contact do not see "
      "each other: look at the surface. Contact/Between = all keeps folds "
      "apart.");
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
        files->message(
          "At t = " + as_text(time_steps.time()) +
          " day Newton's method alone did not find the equilibrium, but a "
          "proximal path did: the tissue folds there, or something jumps in "
          "time. There may be more than one equilibrium: compare with another "
          "Friction/Coefficient, or let what jumps rise over some steps. Column "
          "proximal_paths of statistics.csv counts such steps.");
      }
    if (row.has_long_cells() && !warned_of_long_cells)
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
  void
  Simulation<dim>::write_rows()
  {
    // The rows of one step go to all tables together: a snapshot counts the
    // rows of each, and a resumed run cuts them there.
    const TimerOutput::Scope section(timer, "rows");
    files->step(row, births, events);
    write_work(run_state.n_steps, row.time - row.dt);
    // There is one row a step. The next step makes an estimate of its own only
    // if it finds none.
    condition.reset();
  }

  template <int dim>
  void
  Simulation<dim>::write_work(const unsigned int step, const double begin)
  {
    if (condition)
      files->append("condition", condition_row(step, begin, *condition).text());
    if (!model.scene.output.newton_trace)
      return;
    std::string rows;
    for (const NewtonIteration &state : newton_report.trace)
      rows += newton_row(step, state).text();
    files->append("newton", rows);
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
        const TimerOutput::Scope   section(timer, "output");
        const BoundaryPoints<dim> &points = tissue.boundary_points();
        SurfaceFields<dim>         on_surface(t, points.columns());
        for (unsigned int p = 0; p < points.size(); ++p)
          on_surface.add(points.id(p), points[p], points.position(p));
        files->write_points(cell_table(model, tissue, t),
                            std::move(on_surface),
                            t);
      }
    if (!forces.empty() && files->forces_due(t, last))
      {
        std::string rows;
        for (const ForceRow &row : forces)
          rows += force_row(t, row).text();
        files->append("forces", rows);
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
  FailedStep
  Simulation<dim>::failed_step() const
  {
    // The signs of doc/theory.md, section 5.10, come from the report of the
    // last attempt, and from the first one, whose unbalanced force is what that
    // of the last one is compared with.
    const BoundaryConditions<dim> &conditions = model.boundary_conditions;
    FailedStep                     step;
    step.first_force = first_attempt.force;
    step.last_force  = newton_report.first_residual;
    step.part   = (time_steps.next() - time_steps.time()) / first_attempt.dt;
    step.energy = newton_report.failed_at.energy;
    step.smallest_J = newton_report.failed_at.smallest_J.value;
    step.curvature  = newton_report.curvature;
    step.symmetric  = conditions.has_dirichlet() &&
                     conditions.nitsche().kind() == NitscheForm::symmetric;
    step.loaded =
      conditions.has(SurfaceCondition::loaded) || !model.forces.empty();
    // The friction is that for the whole step, as the user would set it, and
    // not for the last halved attempt.
    step.friction = friction_against(step.curvature,
                                     typical_stiffness,
                                     model.scene.grid.spacing,
                                     first_attempt.dt);
    return step;
  }

  template <int dim>
  void
  Simulation<dim>::give_up_step(const std::string &reason)
  {
    // The message names the step, the reason of its last attempt and the
    // diagnosis before general advice.
    Point<dim> place;
    for (unsigned int d = 0; d < dim; ++d)
      place[d] = newton_report.failed_at.smallest_J.place[d];
    std::ostringstream text;
    text << "the step failed even at a length of "
         << time_steps.next() - time_steps.time()
         << " day (Time/Smallest step = " << model.scene.time.smallest_step
         << "): " << reason << '.'
         << (newton_report.failed_at.smallest_J.place == Point<3>() ?
               "" :
               watches.around(tissue, place, time_steps.time()))
         << diagnosis(failed_step())
         << " Resuming may go on with a smaller Time/Smallest step or other "
            "Solver keys; if it does not, start anew with a larger "
            "Grid/Spacing, with smaller loads or less growth";
    if (model.boundary_conditions.has_dirichlet())
      text << ", or with another Boundary conditions/Nitsche penalty";
    text << '.';
    give_up(text.str());
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
