// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/mechanics/drag.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/vectorized_internal_force.h>
#include <morula/simulation/simulation.h>
#include <morula/simulation/step_checks.h>
#include <morula/simulation/step_points.h>

namespace Morula
{
  template <int dim>
  void
  Simulation<dim>::try_step(const SplineSpace<dim> &space,
                            const RigidModes<dim>  &rigid_modes,
                            Equilibrium::Vector    &u)
  {
    if (development.present())
      {
        const TimerOutput::Scope section(timer, "growth");
        everywhere(comm, [&]() {
          growth_of_step =
            development.of_step(tissue, time_steps.time(), time_steps.next());
        });
        // Of the step's cells, so that a resumed run has the same.
        if (material.depends_on_state())
          find_typical_stiffness();
      }
    MaterialPoints<dim> points;
    {
      const TimerOutput::Scope section(timer, "points");
      points = material_points(tissue, space, growth_of_step, material);
    }
    solve_balance(space, rigid_modes, points, u);

    // A large cell is several quadrature points, but deforms as the field does
    // at its own position: no energy has kept that from turning inside out.
    if (points.subdivided &&
        inverts(DisplacementField<dim>(space, u, comm), tissue.cells(), comm))
      throw StepFailed("a cell is turned inside out");
  }

  template <int dim>
  void
  Simulation<dim>::solve_balance(const SplineSpace<dim>    &space,
                                 const RigidModes<dim>     &rigid_modes,
                                 const MaterialPoints<dim> &points,
                                 Equilibrium::Vector       &u)
  {
    const auto                    list = terms(points, space);
    std::optional<Enclosure<dim>> lumen;
    if (boundary_conditions.lumen() != nullptr)
      {
        const TimerOutput::Scope section(timer, "lumen");
        lumen.emplace(
          enclosure(*boundary_conditions.lumen(), tissue, space, comm));
        everywhere(comm,
                   [&]() { lumen->content = lumen_content(lumen->volume); });
      }
    MomentumBalance<dim> balance(
      space, list, timer, comm, lumen ? &*lumen : nullptr);
    const LinearProblem linear =
      balance.linear_problem(typical_stiffness,
                             inertia(space, rigid_modes),
                             points.xi.size());
    estimate_condition(balance, linear);
    u = start_of_step(space, rigid_modes).value_or(balance.rest());
    Equilibrium::Evaluation evaluation;
    const auto              solve_once = [&]() {
      return solve(balance,
                   linear,
                   balance.scales(typical_stiffness),
                   scene.solver,
                   timer,
                   u,
                   newton_report);
    };
    try
      {
        evaluation =
          lumen ?
            keep_lumen_volume(space, solve_once, balance, lumen->content, u) :
            solve_once();
      }
    catch (const StepFailed &failure)
      {
        throw StepFailed(failure.what() + (". " + balance.describe(u)));
      }
    if (boundary_conditions.has_dirichlet())
      check_gap(balance.extremes(evaluation),
                scene.solver.largest_gap,
                scene.grid.spacing);
  }

  template <int dim>
  std::optional<Equilibrium::Vector>
  Simulation<dim>::start_of_step(const SplineSpace<dim> &space,
                                 const RigidModes<dim>  &modes) const
  {
    if (!boundary_conditions.has_dirichlet())
      return {};
    std::vector<HeldPoint<dim>> points;
    everywhere(comm, [&]() {
      points = held_points(boundary_conditions,
                           tissue,
                           time_steps.time(),
                           time_steps.next());
    });
    return rigid_start(space, modes, points, comm);
  }

  template <int dim>
  void
  Simulation<dim>::estimate_condition(MomentumBalance<dim> &balance,
                                      const LinearProblem  &linear)
  {
    // Once a step, in its first attempt.
    if (!scene.output.condition_estimate || condition)
      return;
    const TimerOutput::Scope section(timer, "condition estimate");
    condition = Morula::estimate_condition(balance, linear, balance.rest());
  }

  template <int dim>
  typename MomentumBalance<dim>::TermList
  Simulation<dim>::terms(const MaterialPoints<dim> &points,
                         const SplineSpace<dim>    &space)
  {
    const double                            t = time_steps.next();
    typename MomentumBalance<dim>::TermList list;
    list.push_back(
      internal_force(points, material.volumetric_form(), scene.solver.kernel));
    // Expressions may have no value at this time: then all ranks must know.
    const auto add = [&](const std::string &name, const auto &make) {
      const TimerOutput::Scope section(timer, name);
      everywhere(comm, [&]() { list.push_back(make()); });
    };
    for (const auto &named : forces)
      add(named.name, [&]() {
        return named.force->term(tissue, cell_positions(tissue, space), t);
      });
    if (boundary_conditions.has_dirichlet())
      add("nitsche", [&]() {
        return nitsche_term(
          boundary_conditions, material, tissue, space, growth_of_step, t);
      });
    add_loads(space, list);
    return list;
  }

  template <int dim>
  void
  Simulation<dim>::add_loads(const SplineSpace<dim>                  &space,
                             typename MomentumBalance<dim>::TermList &list)
  {
    if (!boundary_conditions.has(SurfaceCondition::loaded))
      return;
    std::optional<LoadedPoints<dim>> points;
    for (const auto &named : boundary_conditions.list())
      if (named.condition->kind() == SurfaceCondition::loaded)
        {
          const TimerOutput::Scope section(timer, named.name);
          everywhere(comm, [&]() {
            if (!points)
              {
                points                 = loaded_points(tissue, space);
                points->time           = time_steps.time();
                points->youngs_modulus = typical_stiffness;
              }
            if (auto term = named.condition->term(*points, time_steps.next()))
              list.push_back(std::move(term));
          });
        }
    if (boundary_conditions.has_pushing())
      list.push_back(drag(space));
  }

  template <int dim>
  std::unique_ptr<Term<dim>>
  Simulation<dim>::drag(const SplineSpace<dim> &space) const
  {
    std::vector<double> volumes;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      volumes.push_back(tissue.cells().initial_volume(p));
    return std::make_unique<Drag<dim>>(cell_positions(tissue, space),
                                       std::move(volumes),
                                       Drag<dim>::relative * typical_stiffness /
                                         (scene.grid.spacing *
                                          scene.grid.spacing));
  }

  template <int dim>
  std::vector<typename RigidModes<dim>::Mass>
  Simulation<dim>::masses(const SplineSpace<dim> &space) const
  {
    const Cells<dim>                           &cells = tissue.cells();
    std::vector<typename RigidModes<dim>::Mass> list;
    for (const auto &grid_cell : cells.grid_cells())
      for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
        list.push_back({space.piece(grid_cell.number),
                        cells.position(p),
                        cells.initial_volume(p)});
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
  std::vector<Equilibrium::Vector>
  Simulation<dim>::inertia(const SplineSpace<dim> &space,
                           const RigidModes<dim>  &modes)
  {
    if (!modes.any() || boundary_conditions.has_pushing())
      return {};
    const TimerOutput::Scope section(timer, "rigid motion");
    return modes.inertia(masses(space));
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
