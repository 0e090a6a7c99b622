// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/dead_load.h>
#include <morula/effects/division/divide.h>
#include <morula/mechanics/internal_force.h>
#include <morula/particles/boundary_state.h>
#include <morula/simulation.h>

#include <deal.II/base/mpi.h>

namespace Morula
{
  template <int dim>
  void
  Simulation<dim>::run()
  {
    if (resumed_from && must_stop())
      return;
    files.emplace(scene, resumed_from, comm);
    if (!resumed_from)
      {
        row = statistics();
        files->step(row, births);
        output(must_stop());
      }
    resumed_from.reset();

    while (!must_stop())
      {
        step();
        files->step(row, births);
        output(must_stop());
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
                                              comm) >=
             scene.time.stop_at_cells;
  }

  template <int dim>
  void
  Simulation<dim>::step()
  {
    row = StatisticsRow();
    births.clear();
    ++n_steps;

    const SplineSpace<dim> space = splines();
    Equilibrium::Vector    u;
    solve_step(space, u);
    remove_rigid_motion(space, u);
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
                              Equilibrium::Vector    &u)
  {
    while (true)
      try
        {
          try_step(space, u);
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
                            Equilibrium::Vector    &u)
  {
    if (growth.present())
      {
        const TimerOutput::Scope section(timer, "growth");
        growth_of_step =
          growth.of_step(tissue, time_steps.time(), time_steps.next());
      }
    const MaterialPoints<dim> points = material_points(space);
    const auto                list   = terms(points, space);

    MomentumBalance<dim> balance(space,
                                 list,
                                 typical_stiffness,
                                 rigid_modes(space),
                                 timer,
                                 comm);
    NewtonReport         report;
    try
      {
        solve(balance, scene.solver, timer, u, report);
      }
    catch (const StepFailed &)
      {
        row.newton_iterations += report.newton_iterations;
        row.linear_iterations += report.linear_iterations;
        throw;
      }
    row.newton_iterations += report.newton_iterations;
    row.linear_iterations += report.linear_iterations;
    row.residual = report.residual;
  }

  template <int dim>
  MaterialPoints<dim>
  Simulation<dim>::material_points(const SplineSpace<dim> &space)
  {
    const TimerOutput::Scope section(timer, "points");
    MaterialPoints<dim>      points;
    const auto               state = [&](const CellView<dim, const double> &cell,
                           const Tensor<2, dim>              &F_g) {
      return ElasticState<dim>{cell.deformation() * invert(F_g),
                               cell.initial_volume() *
                                 (material.per_grown_volume ?
                                                  determinant(F_g) :
                                                  1.)};
    };
    const PointGroups groups =
      group_points(tissue.cells(), space, [](const auto &) { return true; });
    points.offsets = groups.offsets;
    points.h       = space.box().spacing();
    if (material.youngs_modulus.is_constant())
      points.lame.push_back(lame(typical_stiffness, material.poissons_ratio));
    for (unsigned int c = 0; c < space.cells().size(); ++c)
      for (unsigned int p = groups.offsets[c]; p < groups.offsets[c + 1]; ++p)
        {
          const auto &particle = tissue.cells().order()[p];
          const auto  cell     = tissue.cell(particle);
          points.xi.push_back(
            space.box().unit_position(particle->get_location(),
                                      space.box().index(
                                        space.cells()[c].number)));
          if (!material.youngs_modulus.is_constant())
            points.lame.push_back(lame(youngs_modulus(cell.founder_position()),
                                       material.poissons_ratio));
          if (growth.present())
            {
              points.previous.push_back(
                state(cell, growth_of_step.previous[p]));
              points.current.push_back(state(cell, growth_of_step.current[p]));
            }
          else
            points.current.push_back(state(cell, cell.growth()));
        }
    return points;
  }

  template <int dim>
  typename MomentumBalance<dim>::TermList
  Simulation<dim>::terms(const MaterialPoints<dim> &points,
                         const SplineSpace<dim>    &space)
  {
    typename MomentumBalance<dim>::TermList list;
    list.push_back(std::make_unique<InternalForce<dim>>(points));
    if (body_force)
      {
        const TimerOutput::Scope    section(timer, "body force");
        std::vector<Tensor<1, dim>> forces;
        for (const auto &particle : tissue.cells().order())
          {
            const auto cell = tissue.cell(particle);
            forces.push_back(
              cell.initial_volume() *
              body_force->vector(cell.founder_position(), time_steps.next()));
          }
        list.push_back(
          std::make_unique<DeadLoad<dim>>(points, std::move(forces)));
      }
    if (boundary_conditions.has_dirichlet() ||
        boundary_conditions.has_traction() ||
        boundary_conditions.has_pressure())
      {
        const TimerOutput::Scope section(timer, "boundary conditions");
        add_boundary_terms(boundary_conditions,
                           material,
                           tissue,
                           space,
                           growth_of_step,
                           time_steps.next(),
                           list);
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
                                       Equilibrium::Vector    &u)
  {
    const RigidModes<dim> modes = rigid_modes(space);
    if (!modes.any())
      return;
    const TimerOutput::Scope section(timer, "rigid motion");
    const typename MomentumBalance<dim>::Local local(space, u, comm);
    std::vector<Tensor<1, dim>>                displacements;
    unsigned int                               c = 0;
    for (const auto &cell : tissue.cells().cells())
      {
        while (space.cells()[c].number != cell.number)
          ++c;
        const LocalField<dim> field = local.field(c);
        const GridIndex<dim>  index = space.box().index(cell.number);
        for (unsigned int p = cell.begin; p < cell.end; ++p)
          displacements.push_back(field.value(SplineValues<dim>(
            space.box().unit_position(
              tissue.cells().order()[p]->get_location(), index),
            space.box().spacing())));
      }
    modes.remove(masses(space), displacements, u);
  }

  template <int dim>
  void
  Simulation<dim>::commit(const SplineSpace<dim>    &space,
                          const Equilibrium::Vector &u)
  {
    const TimerOutput::Scope                   section(timer, "commit");
    const typename MomentumBalance<dim>::Local local(space, u, comm);
    PointList<dim> cells = tissue.cells().copy();
    PointList<dim> boundary_points = tissue.boundary_points().copy();
    // Moves the points of one store, calling update(i, f) for each before.
    const auto move = [&](const PointStore<dim> &store,
                          PointList<dim>        &points,
                          const auto            &update) {
      unsigned int c = 0;
      for (const auto &cell : store.cells())
        {
          while (space.cells()[c].number != cell.number)
            ++c;
          const LocalField<dim> field = local.field(c);
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
           cell.set_tensor(tissue.slots().deformation,
                           f * cell.deformation());
         });
    move(tissue.boundary_points(),
         boundary_points,
         [&](const unsigned int p, const Tensor<2, dim> &f) {
           deform_boundary_point<dim>(
             ArrayView<double>(&boundary_points.properties
                                  [p * boundary_points.n_slots],
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

  template <int dim>
  double
  Simulation<dim>::youngs_modulus(const Point<dim> &X) const
  {
    return material.youngs_modulus.value(X, 0.);
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
