// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/dead_load.h>
#include <morula/effects/division/divide.h>
#include <morula/mechanics/displacement_field.h>
#include <morula/mechanics/internal_force.h>
#include <morula/particles/boundary_state.h>
#include <morula/simulation.h>
#include <morula/step_points.h>

#include <deal.II/base/mpi.h>

#include <iostream>
#include <new>
#include <sstream>

namespace Morula
{
  template <int dim>
  void
  Simulation<dim>::run()
  {
    if (resumed_from && must_stop())
      {
        if (Utilities::MPI::this_mpi_process(comm) == 0)
          std::cout << "Already finished at t = " << time_steps.time()
                    << " day: nothing to resume.\n";
        return;
      }
    files.emplace(scene, resumed_from, comm);
    if (!resumed_from)
      {
        row = statistics();
        files->step(row, births);
        output(must_stop());
      }
    resumed_from.reset();

    try
      {
        while (!must_stop())
          {
            step();
            files->step(row, births);
            output(must_stop());
          }
      }
    catch (const std::bad_alloc &)
      {
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

    files->write_timings(timer);
    files->finish(time_steps.finished() ? "Finished: End time reached" :
                                          "Finished: Stop at cells reached",
                  row,
                  n_rejected,
                  timer);
  }

  template <int dim>
  bool
  Simulation<dim>::must_stop() const
  {
    if (time_steps.finished())
      return true;
    return scene.time.stop_at_cells > 0 &&
           Utilities::MPI::sum<std::uint64_t>(tissue.cells().order().size(),
                                              comm) >= scene.time.stop_at_cells;
  }

  template <int dim>
  void
  Simulation<dim>::step()
  {
    row           = StatisticsRow();
    newton_report = NewtonReport();
    births.clear();
    ++n_steps;

    const SplineSpace<dim> space = splines();
    const RigidModes<dim>  modes = rigid_modes(space);
    Equilibrium::Vector    u;
    solve_step(space, modes, u);
    remove_rigid_motion(space, modes, u);
    commit(space, u);

    row.dt = time_steps.next() - time_steps.time();
    time_steps.accept();
    divide();
    complete_row(space);
  }

  template <int dim>
  SplineSpace<dim>
  Simulation<dim>::splines()
  {
    const TimerOutput::Scope section(timer, "grid");
    return tissue.splines();
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
            give_up(failure.what());
        }
  }

  template <int dim>
  void
  Simulation<dim>::try_step(const SplineSpace<dim> &space,
                            const RigidModes<dim>  &rigid_modes,
                            Equilibrium::Vector    &u)
  {
    if (growth.present())
      {
        const TimerOutput::Scope section(timer, "growth");
        growth_of_step =
          growth.of_step(tissue, time_steps.time(), time_steps.next());
      }
    MaterialPoints<dim> points;
    {
      const TimerOutput::Scope section(timer, "points");
      points = material_points(tissue, space, growth_of_step, material);
    }
    const auto           list = terms(points, space);
    MomentumBalance<dim> balance(
      space, list, typical_stiffness, rigid_modes, timer, comm);
    solve(balance, scene.solver, timer, u, newton_report);
  }

  template <int dim>
  typename MomentumBalance<dim>::TermList
  Simulation<dim>::terms(const MaterialPoints<dim> &points,
                         const SplineSpace<dim>    &space)
  {
    const double                            t = time_steps.next();
    typename MomentumBalance<dim>::TermList list;
    list.push_back(std::make_unique<InternalForce<dim>>(points));
    if (body_force)
      {
        const TimerOutput::Scope    section(timer, "body force");
        std::vector<Tensor<1, dim>> forces;
        for (const auto &particle : tissue.cells().order())
          {
            const auto cell = tissue.cell(particle);
            forces.push_back(cell.initial_volume() *
                             body_force->vector(cell.founder_position(), t));
          }
        list.push_back(
          std::make_unique<DeadLoad<dim>>(cell_positions(tissue, space),
                                          std::move(forces)));
      }
    if (boundary_conditions.has_dirichlet())
      {
        const TimerOutput::Scope section(timer, "nitsche");
        list.push_back(nitsche_term(
          boundary_conditions, material, tissue, space, growth_of_step, t));
      }
    if (boundary_conditions.has_traction())
      {
        const TimerOutput::Scope section(timer, "traction");
        list.push_back(traction_term(boundary_conditions, tissue, space, t));
      }
    if (boundary_conditions.has_pressure())
      {
        const TimerOutput::Scope section(timer, "pressure");
        list.push_back(pressure_term(boundary_conditions, tissue, space, t));
      }
    return list;
  }

  template <int dim>
  std::vector<typename RigidModes<dim>::Mass>
  Simulation<dim>::masses(const SplineSpace<dim> &space) const
  {
    std::vector<typename RigidModes<dim>::Mass> list;
    for (const auto &cell : tissue.cells().cells())
      for (unsigned int p = cell.begin; p < cell.end; ++p)
        {
          const auto &particle = tissue.cells().order()[p];
          list.push_back({space.piece(cell.number),
                          particle->get_location(),
                          tissue.cell(particle).initial_volume()});
        }
    return list;
  }

  template <int dim>
  RigidModes<dim>
  Simulation<dim>::rigid_modes(const SplineSpace<dim> &space) const
  {
    return RigidModes<dim>(space,
                           masses(space),
                           supports(boundary_conditions, tissue, space),
                           comm);
  }

  template <int dim>
  void
  Simulation<dim>::remove_rigid_motion(const SplineSpace<dim> &space,
                                       const RigidModes<dim>  &modes,
                                       Equilibrium::Vector    &u)
  {
    if (!modes.any())
      return;
    const TimerOutput::Scope     section(timer, "rigid motion");
    const DisplacementField<dim> displacement(space, u, comm);
    std::vector<Tensor<1, dim>>  displacements;
    unsigned int                 c = 0;
    for (const auto &cell : tissue.cells().cells())
      {
        while (space.cells()[c].number != cell.number)
          ++c;
        const LocalField<dim> field = displacement.on_cell(c);
        const GridIndex<dim>  index = space.box().index(cell.number);
        for (unsigned int p = cell.begin; p < cell.end; ++p)
          displacements.push_back(field.value(SplineValues<dim>(
            space.box().unit_position(tissue.cells().order()[p]->get_location(),
                                      index),
            space.box().spacing())));
      }
    modes.remove(masses(space), displacements, u);
  }

  template <int dim>
  void
  Simulation<dim>::commit(const SplineSpace<dim>    &space,
                          const Equilibrium::Vector &u)
  {
    const TimerOutput::Scope     section(timer, "commit");
    const DisplacementField<dim> displacement(space, u, comm);
    PointList<dim>               cells = tissue.cells().copy();
    PointList<dim> boundary_points     = tissue.boundary_points().copy();
    // Moves the points of one store, calling update(i, f) for each before.
    const auto move = [&](const PointStore<dim> &store,
                          PointList<dim>        &points,
                          const auto            &update) {
      unsigned int c = 0;
      for (const auto &cell : store.cells())
        {
          while (space.cells()[c].number != cell.number)
            ++c;
          const LocalField<dim> field = displacement.on_cell(c);
          const GridIndex<dim>  index = space.box().index(cell.number);
          for (unsigned int p = cell.begin; p < cell.end; ++p)
            {
              const SplineValues<dim> splines(
                space.box().unit_position(points.positions[p], index),
                space.box().spacing());
              update(p, field.step_deformation(splines));
              points.positions[p] += field.value(splines);
            }
        }
    };
    move(tissue.cells(),
         cells,
         [&](const unsigned int p, const Tensor<2, dim> &f) {
           const CellView<dim, double> cell(
             ArrayView<double>(&cells.properties[p * cells.n_slots],
                               cells.n_slots),
             tissue.slots());
           if (growth.present())
             growth.commit(cell,
                           time_steps.time(),
                           time_steps.next(),
                           growth_of_step.current[p]);
           cell.set_tensor(tissue.slots().deformation, f * cell.deformation());
         });
    move(tissue.boundary_points(),
         boundary_points,
         [&](const unsigned int p, const Tensor<2, dim> &f) {
           deform_boundary_point<dim>(
             ArrayView<double>(
               &boundary_points.properties[p * boundary_points.n_slots],
               boundary_points.n_slots),
             f);
         });
    tissue.place(cells, boundary_points);
  }

  template <int dim>
  void
  Simulation<dim>::divide()
  {
    if (growth.cycle() == nullptr)
      return;
    const std::vector<unsigned int> due =
      cells_due(tissue, *growth.cycle(), time_steps.time());
    row.dividing = Utilities::MPI::sum<std::uint64_t>(due.size(), comm);
    if (row.dividing == 0)
      return;
    const TimerOutput::Scope section(timer, "division");
    births = Morula::divide(tissue, *growth.cycle(), due, next_id);
  }

  template <int dim>
  unsigned int
  Simulation<dim>::n_unknowns()
  {
    return splines().n_unknowns();
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
