// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/state/surface_distance.h>
#include <morula/output/cell_fields.h>
#include <morula/output/surface_fields.h>
#include <morula/particles/cell_domain.h>
#include <morula/particles/surface_refinement.h>
#include <morula/simulation/simulation.h>
#include <morula/simulation/snapshot_check.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <ostream>
#include <sstream>

namespace Morula
{
  namespace
  {
    template <int dim>
    void
    count_splines(const SplineSpace<dim> &space, StatisticsRow &row)
    {
      row.active_grid_cells = space.n_active_grid_cells();
      row.inner_splines     = space.n_inner_splines();
      row.outer_splines     = space.n_outer_splines();
      row.unknowns          = dim * space.n_unknowns();
    }
  } // namespace

  template <int dim>
  Simulation<dim>::Simulation(const Scene   &scene,
                              const MPI_Comm comm,
                              const bool     resume)
    : Simulation(scene, comm, effects_of<dim>(scene))
  {
    const TimerOutput::Scope section(timer, "seeding");
    if (resume)
      restore();
    else
      seed(seed_tissue<dim>(scene, comm));
    find_typical_stiffness();
  }

  template <int dim>
  Simulation<dim>::Simulation(const Scene             &scene,
                              const MPI_Comm           comm,
                              const SeededTissue<dim> &seeded)
    : Simulation(scene, comm, effects_of<dim>(scene))
  {
    const TimerOutput::Scope section(timer, "seeding");
    seed(seeded);
    find_typical_stiffness();
  }

  template <int dim>
  Simulation<dim>::Simulation(const Scene        &scene,
                              const MPI_Comm      comm,
                              SceneEffects<dim> &&effects)
    : scene(scene)
    , comm(comm)
    , timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
    , material(scene.material)
    , boundary_conditions(std::move(effects.conditions), scene.nitsche)
    , development(std::move(effects.development),
                  effects.columns,
                  effects.state,
                  material,
                  scene.random_seed)
    , fields(std::move(effects.fields))
    , fates(std::move(effects.fates))
    , forces(std::move(effects.forces))
    , tissue(scene.grid,
             development.columns(),
             comm,
             BoundaryColumns<dim>(scene.tissue.refine_surface,
                                  scene.tissue.coarsen_surface))
    , time_steps(scene.time)
  {}

  template <int dim>
  void
  Simulation<dim>::find_typical_stiffness()
  {
    double largest = 0.;
    if (material.depends_on_state())
      for (const Lame &lame : growth_of_step.lame)
        largest = std::max(largest, youngs_modulus(lame));
    else
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        largest =
          std::max(largest,
                   material.youngs_modulus(tissue.cells().founder_position(p)));
    typical_stiffness = Utilities::MPI::max(largest, comm);
  }

  template <int dim>
  void
  Simulation<dim>::seed(const SeededTissue<dim> &seeded)
  {
    const Founders<dim>       &founders = seeded.founders;
    const SurfacePatches<dim> &patches  = seeded.surface;
    warnings                            = seeded.warnings;

    const CellColumns<dim> &columns = tissue.cells().columns();
    PointList<dim>          cells(columns.n_numbers());
    cells.reserve(founders.positions.size());
    births.reserve(founders.positions.size());
    const StateColumns<dim>      &state = development.state();
    std::vector<NearSurface<dim>> surface;
    if (state.needs_surface())
      surface = near_surface(founders.positions,
                             patches.positions,
                             patches.normals,
                             comm);
    const CellReader<dim> reader = development.reader(0.);
    everywhere(comm, [&]() {
      for (std::size_t i = 0; i < founders.positions.size(); ++i)
        {
          const Point<dim>            X  = founders.positions[i];
          const types::particle_index id = founders.first_id + i;
          std::vector<double> row = columns.founder(X, founders.volumes[i]);
          const CellView<dim, double> cell(make_array_view(row), columns);
          if (state.depth.exists())
            cell.set(state.depth, surface[i].depth);
          if (state.surface_normal.exists())
            cell.set(state.surface_normal, surface[i].normal);
          const unsigned int generation =
            founders.generations.empty() ? 0 : founders.generations[i];
          if (columns.generation.exists())
            cell.set(columns.generation, generation);
          fields.begin(cell);
          GivenState given;
          if (!founders.phases.empty())
            given.phase = founders.phases[i];
          if (!founders.types.empty())
            given.type = founders.types[i];
          development.initialize(id, cell, scene.time.step, given);
          if (fields.present())
            fields.check_cell({cell, id, X, reader});
          cells.add(id, X, make_array_view(row));
          births.push_back({id, -1, generation, 0., X, type_of(cell)});
        }
    });

    const BoundaryColumns<dim> &boundary = tissue.boundary_points().columns();
    PointList<dim>              points(boundary.n_numbers());
    for (std::size_t i = 0; i < patches.positions.size(); ++i)
      {
        const Point<dim>          X   = patches.positions[i];
        const Tensor<1, dim>      N   = patches.normals[i];
        const std::vector<double> row = boundary.initial_point(
          X, N, patches.areas[i], boundary_conditions.condition(X, N));
        points.add(patches.first_id + i, X, make_array_view(row));
      }
    tissue.place(cells, points);
    next_id          = founders.n_global;
    next_boundary_id = patches.n_global;
    refine_surface([](const Point<dim> &) { return false; });
    begin_lumen();
  }

  template <int dim>
  void
  Simulation<dim>::restore()
  {
    const std::string path = scene.output_directory + "/snapshot.h5";
    check_resumable(scene, read_snapshot_parameters(path, comm));
    resumed_from = read_snapshot<dim>(path, comm);
    check_columns(*resumed_from,
                  tissue.cells().columns(),
                  tissue.boundary_points().columns(),
                  comm);

    const std::vector<int> &box_first =
      resumed_from->integer_table("box_first", dim);
    const std::vector<int> &box_n = resumed_from->integer_table("box_n", dim);
    GridIndex<dim>          first, n;
    std::size_t             n_grid_cells = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        first[d] = box_first[d];
        n[d]     = box_n[d];
        if (box_n[d] <= 0)
          refuse_snapshot(path, "a snapshot whose grid has cells");
        n_grid_cells *= box_n[d];
      }
    const std::vector<int> &weights =
      resumed_from->integer_table("box_weights", n_grid_cells);
    const auto number = [this](const std::string &name) {
      return resumed_from->number(name);
    };
    next_id = number("next_id");
    if (scene.tissue.refine_surface)
      next_boundary_id = number("next_boundary_id");
    restore_lumen();
    n_steps    = number("steps");
    n_rejected = number("rejected_steps");
    time_steps.restore({resumed_from->time,
                        number("step_length"),
                        static_cast<unsigned int>(number("step_interval")),
                        number("step_begin"),
                        static_cast<unsigned int>(number("step_part")),
                        static_cast<unsigned int>(number("step_level"))});
    tissue.restore(resumed_from->cells,
                   resumed_from->boundary_points,
                   first,
                   n,
                   std::vector<unsigned int>(weights.begin(), weights.end()));
    row = statistics();
    check_resumed_cycle();
  }

  template <int dim>
  void
  Simulation<dim>::check_resumed_cycle() const
  {
    if (development.cycle() == nullptr)
      return;
    std::vector<Point<dim>> founders;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      founders.push_back(tissue.cells().founder_position(p));
    everywhere(comm, [&]() {
      development.cycle()->check(founders, scene.time.step);
    });
  }

  template <int dim>
  SnapshotData<dim>
  Simulation<dim>::snapshot() const
  {
    SnapshotData<dim> data;
    data.program_version       = MORULA_VERSION;
    const TimeSteps::State now = time_steps.state();
    data.time                  = now.time;
    data.numbers               = {{"next_id", double(next_id)},
                                  {"steps", double(n_steps)},
                                  {"rejected_steps", double(n_rejected)},
                                  {"step_length", now.step},
                                  {"step_interval", double(now.interval)},
                                  {"step_begin", now.begin},
                                  {"step_part", double(now.part)},
                                  {"step_level", double(now.level)}};
    if (scene.tissue.refine_surface)
      data.numbers["next_boundary_id"] = next_boundary_id;
    save_lumen(data);
    const GridBox<dim> &box = tissue.grid().box();
    data.integer_tables["box_first"].assign(box.first().begin(),
                                            box.first().end());
    data.integer_tables["box_n"].assign(box.n().begin(), box.n().end());
    data.integer_tables["box_weights"].assign(tissue.grid().weights().begin(),
                                              tissue.grid().weights().end());
    data.cells            = tissue.cells().copy();
    data.boundary_points  = tissue.boundary_points().copy();
    data.cell_columns     = tissue.cells().columns().layout();
    data.boundary_columns = tissue.boundary_points().columns().layout();
    return data;
  }

  template <int dim>
  unsigned int
  Simulation<dim>::type_of(const CellView<dim, const double> &cell) const
  {
    const auto &type = development.state().type;
    return type.exists() ? cell.get(type) : 0;
  }

  template <int dim>
  PresentCell<dim>
  Simulation<dim>::present_cell(const unsigned int     p,
                                const CellReader<dim> &reader) const
  {
    const Cells<dim> &cells = tissue.cells();
    return {cells[p], cells.id(p), cells.position(p), reader};
  }

  template <int dim>
  bool
  Simulation<dim>::is_held(const PresentCell<dim> &cell) const
  {
    const CellCycle<dim> *cycle = development.cycle();
    return cycle != nullptr &&
           cycle->is_held(development.clock(cell.cell()),
                          CellAt<dim>(cell, time_steps.time()),
                          time_steps.time(),
                          cell.cell().elastic_volume_ratio());
  }

  template <int dim>
  CellQuantities
  Simulation<dim>::quantities(const unsigned int p) const
  {
    const CellReader<dim> reader = development.reader(time_steps.time());
    return present_cell(p, reader).quantities();
  }

  template <int dim>
  StatisticsRow
  Simulation<dim>::statistics() const
  {
    StatisticsRow              state;
    TissueSums<dim>            sums;
    LongestCell<dim>           longest(scene.grid.spacing);
    std::vector<std::uint64_t> of_types(development.state().type_names().size(),
                                        0);
    std::uint64_t              held   = 0;
    std::uint64_t              dying  = 0;
    const Cells<dim>          &cells  = tissue.cells();
    const auto                 reader = development.reader(time_steps.time());
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const PresentCell<dim> cell = present_cell(p, reader);
        sums.add_cell(cell.quantities(), cell.position());
        held += is_held(cell);
        if (const Death<dim> *death = development.death())
          dying += death->is_dead(cells[p]);
        if (!of_types.empty())
          ++of_types[cell.type()];
        longest.add(cell_domain<dim>(cell.position(), cell.cell()));
      }
    for (unsigned int p = 0; p < tissue.boundary_points().size(); ++p)
      sums.add_boundary_point(tissue.boundary_points().position(p));
    state.step    = n_steps;
    state.time    = time_steps.time();
    state.cells   = Utilities::MPI::sum<std::uint64_t>(cells.size(), comm);
    state.tissue  = sums.totals(comm);
    state.lengths = longest.over_all_ranks(comm);
    state.held_at_checkpoint = Utilities::MPI::sum(held, comm);
    if (development.death() != nullptr)
      state.death =
        DeathCounts{Utilities::MPI::sum(dying, comm), 0, 0, n_pieces};
    Utilities::MPI::sum(of_types, comm, of_types);
    for (std::size_t type = 0; type < of_types.size(); ++type)
      state.cells_of_types.emplace_back(development.state().type_names()[type],
                                        of_types[type]);
    state.lumen  = lumen_state();
    state.fields = field_statistics();
    return state;
  }

  template <int dim>
  void
  Simulation<dim>::begin_rows()
  {
    first_splines.emplace(splines());
    set_steady_fields(*first_splines);
    field_solver.reset(); // the splines will stand elsewhere
    count_pieces(*first_splines);
    row = statistics();
    count_splines(*first_splines, row);
  }

  template <int dim>
  void
  Simulation<dim>::complete_row(const SplineSpace<dim> &space)
  {
    const TimerOutput::Scope section(timer, "statistics");
    StatisticsRow            complete = statistics();
    complete.dt                       = row.dt;
    complete.dividing                 = row.dividing;
    if (row.death)
      {
        complete.death->deaths  = row.death->deaths;
        complete.death->removed = row.death->removed;
      }
    count_splines(space, complete);
    complete.newton_iterations = newton_report.newton_iterations;
    complete.linear_iterations = newton_report.linear_iterations;
    complete.rejected_steps    = row.rejected_steps;
    complete.residual          = newton_report.residual;
    row                        = complete;
    warn_of_long_cells();
  }

  template <int dim>
  void
  Simulation<dim>::warn_of_long_cells()
  {
    if (row.lengths.n_too_long == 0 || warned_of_long_cells)
      return;
    warned_of_long_cells     = true;
    const auto        &place = row.lengths.place;
    std::ostringstream text;
    text << "Warning: from t = " << row.time << " day on, fewer than "
         << CellLengths::fewest
         << " cells fill Grid/Spacing = " << scene.grid.spacing
         << " um where the tissue is stretched: " << row.lengths.n_too_long
         << (row.lengths.n_too_long == 1 ? " cell is" : " cells are")
         << " too long, the longest, at (" << place[0] << ' ' << place[1];
    if (dim == 3)
      text << ' ' << place[2];
    text << ") um, " << scene.grid.spacing / row.lengths.min_cells_per_spacing
         << " um. Do not rely on positions and stresses there, and if it gets "
            "worse the run may fail. Start anew with a smaller Tissue/Cell "
            "spacing or a larger Grid/Spacing; the column "
            "min_cells_per_spacing of statistics.csv has the number.";
    files->message(text.str());
  }

  template <int dim>
  void
  Simulation<dim>::output(const bool last)
  {
    const double t = time_steps.time();
    if (files->writes_points() && files->output_due(t, last))
      {
        const TimerOutput::Scope section(timer, "output");
        const bool has_checkpoint = development.cycle() != nullptr &&
                                    development.cycle()->has_checkpoint();
        const Cells<dim>          &cells  = tissue.cells();
        const BoundaryPoints<dim> &points = tissue.boundary_points();
        CellFields<dim> table(t, cells.size(), cells.columns(), has_checkpoint);
        const auto      reader = development.reader(t);
        for (unsigned int p = 0; p < cells.size(); ++p)
          {
            const PresentCell<dim> cell = present_cell(p, reader);
            table.add(cells.id(p),
                      cells[p],
                      cells.position(p),
                      reader.phase(cells[p]),
                      is_held(cell),
                      cell.quantities());
          }
        SurfaceFields<dim> surface(t, points.columns());
        for (unsigned int p = 0; p < points.size(); ++p)
          surface.add(points.id(p), points[p], points.position(p));
        files->write_points(table.fields(), surface.fields(), t);
      }
    if (files->snapshot_due(t, last))
      files->write_snapshot(snapshot(), timer);
  }

  template <int dim>
  void
  Simulation<dim>::stop_if_asked(const StopSignals &signals)
  {
    const int signal = signals.received();
    if (signal == 0)
      return;
    files->write_snapshot(snapshot(), timer);
    files->write_timings(timer);
    throw StoppedBySignal(signal, time_steps.time());
  }

  template <int dim>
  void
  Simulation<dim>::give_up(const std::string &reason)
  {
    --n_steps; // not done
    files->write_snapshot(snapshot(), timer);
    // Behind the snapshot, as the step is repeated when the run is resumed.
    if (condition)
      files->condition(n_steps + 1, time_steps.time(), *condition);
    files->write_timings(timer);
    throw std::runtime_error(reason + " The state is saved in snapshot.h5.");
  }

  template <int dim>
  double
  Simulation<dim>::way_of_held_points() const
  {
    double largest = 0.;
    everywhere(comm, [&]() {
      for (const auto &point : held_points(
             boundary_conditions, tissue, time_steps.time(), time_steps.next()))
        largest = std::max(largest, point.from.distance(point.to));
    });
    return Utilities::MPI::max(largest, comm);
  }

  template <int dim>
  void
  Simulation<dim>::give_up_step(const std::string &reason)
  {
    std::ostringstream text;
    text << "the step failed even at a length of "
         << time_steps.next() - time_steps.time()
         << " day (Time/Smallest step = " << scene.time.smallest_step
         << "): " << reason
         << ". Resuming may go on with a smaller Time/Smallest step or other "
            "Solver keys; if it does not, start anew with a larger "
            "Grid/Spacing, with smaller loads or less growth";
    if (boundary_conditions.has_dirichlet())
      text << ", or with another Boundary conditions/Nitsche penalty";
    text << '.';
    if (const double way = way_of_held_points(); way > 0.5 * scene.grid.spacing)
      text << " Even in so short a step held points move by " << way
           << " um: let Boundary conditions/Displacement rise from 0 with t.";
    give_up(text.str());
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
