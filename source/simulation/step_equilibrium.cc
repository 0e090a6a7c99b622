// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/effects/surface/lumen.h>
#include <morula/mechanics/drag.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/vectorized_internal_force.h>
#include <morula/simulation/step_checks.h>
#include <morula/simulation/step_equilibrium.h>
#include <morula/simulation/step_points.h>
#include <morula/solver/proximal_path.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  namespace
  {
    /** Makes the extremes of the states from number @p begin on those of all
     *  ranks. Collective. */
    template <int dim>
    void
    share_extremes(const MomentumBalance<dim> &balance,
                   const std::size_t           begin,
                   NewtonReport               &report)
    {
      for (std::size_t i = begin; i < report.trace.size(); ++i)
        report.trace[i].evaluation.smallest_J =
          balance.smallest_J(report.trace[i].evaluation);
    }
  } // namespace


  template <int dim>
  StepEquilibrium<dim>::StepEquilibrium(const TissueModel<dim> &model,
                                        const Tissue<dim>      &tissue,
                                        const SplineSpace<dim> &space,
                                        const Supports         &supports,
                                        TimerOutput            &timer,
                                        const MPI_Comm          comm)
    : model(model)
    , tissue(tissue)
    , space(space)
    , timer(timer)
    , comm(comm)
    , rigid_modes(space, masses(), supports, comm)
  {}


  template <int dim>
  typename StepEquilibrium<dim>::Solution
  StepEquilibrium<dim>::solve(const Attempt                    &attempt,
                              NewtonReport                     &report,
                              std::optional<ConditionEstimate> &condition) const
  {
    MaterialPoints<dim> points;
    {
      const TimerOutput::Scope section(timer, "points");
      points = material_points(tissue, space, attempt.growth, model.material);
    }
    Solution solution = balance(attempt, points, report, condition);

    // A large cell is several quadrature points, but deforms as the field does
    // at its own position: no energy has kept that from turning inside out.
    if (points.subdivided &&
        inverts(DisplacementField<dim>(space, solution.u, comm),
                tissue.cells(),
                comm))
      throw StepFailed("a cell is turned inside out");
    return solution;
  }


  template <int dim>
  typename StepEquilibrium<dim>::Solution
  StepEquilibrium<dim>::balance(
    const Attempt                    &attempt,
    const MaterialPoints<dim>        &points,
    NewtonReport                     &report,
    std::optional<ConditionEstimate> &condition) const
  {
    const double                     stiffness = attempt.typical_stiffness;
    std::optional<HeldTraction<dim>> traction;
    if (model.boundary_conditions.has_dirichlet() &&
        model.boundary_conditions.nitsche().form() == NitscheForm::bounded)
      {
        const TimerOutput::Scope section(timer, "nitsche");
        everywhere(comm, [&]() {
          traction.emplace(model,
                           tissue,
                           space,
                           attempt.growth,
                           stiffness,
                           !attempt.halve_first);
        });
      }
    const TermList list =
      terms(attempt, points, traction ? &*traction : nullptr);
    std::optional<Enclosure<dim>> lumen = lumen_of(attempt);
    MomentumBalance<dim>          balance(
      space, list, timer, comm, lumen ? &*lumen : nullptr);
    const LinearProblem linear =
      balance.linear_problem(stiffness, inertia(), tissue.cells().size());
    estimate_condition(balance, linear, condition);
    Solution solution{start(attempt).value_or(balance.rest()),
                      attempt.lumen,
                      {}};
    if (traction)
      traction->predict(solution.u);
    std::optional<LumenPressure<dim>> pressure;
    std::vector<TurnParticipant *>    participants;
    if (lumen)
      participants.push_back(
        &pressure.emplace(*model.boundary_conditions.lumen(),
                          tissue,
                          space,
                          balance,
                          lumen->content,
                          timer));
    if (traction)
      participants.push_back(&*traction);
    Equilibrium::Evaluation evaluation;
    const std::size_t       n_traced = report.trace.size();
    try
      {
        evaluation = balance_in_turns(
          balance,
          participants,
          [&]() { return find(attempt, balance, linear, solution.u, report); },
          solution.u,
          report);
        share_extremes(balance, n_traced, report);
      }
    catch (const StepFailed &failure)
      {
        share_extremes(balance, n_traced, report);
        Equilibrium::Vector R(solution.u);
        report.failed_at            = balance.residual(solution.u, R);
        report.failed_at.smallest_J = balance.smallest_J(report.failed_at);
        throw StepFailed(failure.what() +
                         (". " + balance.describe(solution.u)));
      }
    if (pressure)
      solution.lumen->pressure = pressure->pressure();
    solution.forces = forces(attempt, list, lumen, solution);
    if (model.boundary_conditions.has_dirichlet())
      check_gap(balance.extremes(evaluation),
                model.scene.solver.largest_gap,
                space.box().spacing());
    return solution;
  }


  // A step that is plainly too long is halved: that is cheaper than a path, and
  // as good. All other failures have a path to their equilibrium, as the energy
  // has a lowest value; half the step would begin with as much unbalanced force
  // where the last state is about to fold, or where something jumps.
  template <int dim>
  Equilibrium::Evaluation
  StepEquilibrium<dim>::find(const Attempt        &attempt,
                             MomentumBalance<dim> &balance,
                             const LinearProblem  &linear,
                             Equilibrium::Vector  &u,
                             NewtonReport         &report) const
  {
    const Equilibrium::Vector begin(u);
    NewtonScales scales = balance.scales(attempt.typical_stiffness);
    // A later turn begins with what the renewed traction has changed, and need
    // not be balanced more exactly than the first one.
    if (report.place.turn > 1 && !attempt.lumen)
      scales.small_force = std::max(scales.small_force, report.first_residual);
    try
      {
        return Morula::solve(
          balance, linear, scales, model.scene.solver, timer, u, report);
      }
    catch (const StepFailed &)
      {
        if (attempt.halve_first && balance.is_far_from(begin, u))
          throw;
        u = begin;
        return follow_proximal_path(
          balance, linear, scales, model.scene.solver, timer, u, report);
      }
  }


  // The terms of conditions that load are made anew, apart from each other;
  // that of the points that are held stands behind those of the cells.
  template <int dim>
  SurfaceForces<dim>
  StepEquilibrium<dim>::forces(const Attempt                       &attempt,
                               const TermList                      &list,
                               const std::optional<Enclosure<dim>> &lumen,
                               const Solution &solution) const
  {
    const BoundaryConditions<dim> &conditions = model.boundary_conditions;
    if (conditions.list().empty())
      return {};
    const TimerOutput::Scope section(timer, "forces");
    ForceSums<dim>           sums(tissue, space, solution.u, comm);
    for (std::size_t f = 0; f < model.forces.size(); ++f)
      sums.add_force(model.forces[f].name, *list[1 + f]);
    if (conditions.has_dirichlet())
      sums.add_held(conditions, *list[1 + model.forces.size()]);
    if (conditions.has(SurfaceCondition::loaded))
      {
        LoadedPoints<dim> points = loaded_points(tissue, space);
        points.time              = attempt.t;
        points.youngs_modulus    = attempt.typical_stiffness;
        sums.add_loads(conditions, points, attempt.t_next);
      }
    if (lumen)
      sums.add_lumen(*conditions.lumen(),
                     lumen->gain,
                     solution.lumen->pressure);
    return sums.result();
  }


  template <int dim>
  std::optional<Enclosure<dim>>
  StepEquilibrium<dim>::lumen_of(const Attempt &attempt) const
  {
    if (!attempt.lumen)
      return {};
    const TimerOutput::Scope section(timer, "lumen");
    const Lumen<dim>        &lumen = *model.boundary_conditions.lumen();
    Enclosure<dim>           found = enclosure(lumen, tissue, space, comm);
    everywhere(comm, [&]() {
      found.content = lumen_content(lumen,
                                    *attempt.lumen,
                                    attempt.t_next,
                                    found.volume,
                                    attempt.typical_stiffness);
    });
    return found;
  }


  template <int dim>
  std::optional<Equilibrium::Vector>
  StepEquilibrium<dim>::start(const Attempt &attempt) const
  {
    if (!model.boundary_conditions.has_dirichlet())
      return {};
    std::vector<HeldPoint<dim>> points;
    everywhere(comm, [&]() {
      points = held_points(model.boundary_conditions,
                           tissue,
                           attempt.t,
                           attempt.t_next);
    });
    return rigid_start(space, rigid_modes, points, comm);
  }


  template <int dim>
  void
  StepEquilibrium<dim>::estimate_condition(
    MomentumBalance<dim>             &balance,
    const LinearProblem              &linear,
    std::optional<ConditionEstimate> &condition) const
  {
    // Once a step, in its first attempt.
    if (!model.scene.output.condition_estimate || condition)
      return;
    const TimerOutput::Scope section(timer, "condition estimate");
    condition = Morula::estimate_condition(balance, linear, balance.rest());
  }


  template <int dim>
  typename StepEquilibrium<dim>::TermList
  StepEquilibrium<dim>::terms(const Attempt             &attempt,
                              const MaterialPoints<dim> &points,
                              const HeldTraction<dim>   *traction) const
  {
    const double t = attempt.t_next;
    TermList     list;
    list.push_back(internal_force(points,
                                  model.material.volumetric_form(),
                                  model.scene.solver.kernel));
    // Expressions may have no value at this time: then all ranks must know.
    const auto add = [&](const std::string &name, const auto &make) {
      const TimerOutput::Scope section(timer, name);
      everywhere(comm, [&]() { list.push_back(make()); });
    };
    for (const auto &named : model.forces)
      add(named.name, [&]() {
        return named.force->term(tissue,
                                 model.development.reader(attempt.t),
                                 cell_positions(tissue, space),
                                 attempt.t,
                                 t);
      });
    if (model.boundary_conditions.has_dirichlet())
      add("nitsche", [&]() {
        if (traction != nullptr)
          return bounded_nitsche_term(model.boundary_conditions,
                                      model.material,
                                      tissue,
                                      space,
                                      attempt.growth,
                                      t,
                                      traction->stiffnesses(),
                                      traction->tractions());
        return nitsche_term(model.boundary_conditions,
                            model.material,
                            tissue,
                            space,
                            attempt.growth,
                            t,
                            model.scene.solver.kernel);
      });
    add_loads(attempt, list);
    return list;
  }


  template <int dim>
  void
  StepEquilibrium<dim>::add_loads(const Attempt &attempt, TermList &list) const
  {
    const BoundaryConditions<dim> &conditions = model.boundary_conditions;
    if (!conditions.has(SurfaceCondition::loaded))
      return;
    std::optional<LoadedPoints<dim>> points;
    for (const auto &named : conditions.list())
      if (named.condition->kind() == SurfaceCondition::loaded)
        {
          const TimerOutput::Scope section(timer, named.name);
          everywhere(comm, [&]() {
            if (!points)
              {
                points                 = loaded_points(tissue, space);
                points->time           = attempt.t;
                points->youngs_modulus = attempt.typical_stiffness;
              }
            if (auto term = named.condition->term(*points, attempt.t_next))
              list.push_back(std::move(term));
          });
        }
    if (conditions.has_pushing())
      list.push_back(weak_drag(attempt.typical_stiffness));
  }


  template <int dim>
  std::unique_ptr<Term<dim>>
  StepEquilibrium<dim>::weak_drag(const double typical_stiffness) const
  {
    const double        h   = space.box().spacing();
    const double        eta = Drag<dim>::least * typical_stiffness / (h * h);
    std::vector<double> stiffnesses;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      stiffnesses.push_back(eta * tissue.cells().initial_volume(p));
    return std::make_unique<Drag<dim>>(cell_positions(tissue, space),
                                       std::move(stiffnesses));
  }


  template <int dim>
  typename StepEquilibrium<dim>::MassList
  StepEquilibrium<dim>::masses() const
  {
    const Cells<dim> &cells = tissue.cells();
    MassList          list;
    for (const auto &grid_cell : cells.grid_cells())
      for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
        list.push_back({space.piece(grid_cell.number),
                        cells.position(p),
                        cells.initial_volume(p)});
    return list;
  }


  template <int dim>
  std::vector<Equilibrium::Vector>
  StepEquilibrium<dim>::inertia() const
  {
    if (!rigid_modes.any() || model.boundary_conditions.has_pushing())
      return {};
    const TimerOutput::Scope section(timer, "rigid motion");
    return rigid_modes.inertia(masses());
  }


  template class StepEquilibrium<2>;
  template class StepEquilibrium<3>;
} // namespace Morula
