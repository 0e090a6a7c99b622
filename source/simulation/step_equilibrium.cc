// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/effects/volumes_of_step.h>
#include <morula/mechanics/internal_force.h>
#include <morula/mechanics/point_term.h>
#include <morula/mechanics/spline_field.h>
#include <morula/simulation/step_checks.h>
#include <morula/simulation/step_equilibrium.h>
#include <morula/solver/newton.h>
#include <morula/solver/proximal_path.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  /** The work of a StepEquilibrium. */
  template <int dim>
  class StepEquilibrium<dim>::Work
  {
  public:
    Work(const TissueModel<dim> &model,
         const Tissue<dim>      &tissue,
         const SplineSpace<dim> &space,
         const Supports         &supports,
         TimerOutput            &timer,
         const MPI_Comm          comm,
         const Encounters<dim>  *encounters)
      : model(model)
      , tissue(tissue)
      , space(space)
      , timer(timer)
      , comm(comm)
      , supports(supports)
      , rigid_modes(space, masses(), supports, comm)
      , encounters(encounters)
    {}

    Solution
    solve(const Attempt                    &attempt,
          NewtonReport                     &report,
          std::optional<ConditionEstimate> &condition) const
    {
      MaterialPoints<dim> points;
      {
        const TimerOutput::Scope section(timer, "points");
        points = material_points(tissue, space, attempt.growth, model.material);
      }
      Solution solution = balance(attempt, points, report, condition);

      // A large cell is several quadrature points, but deforms as the field
      // does at its own position, which the energy does not see.
      if (points.subdivided &&
          inverts(DisplacementField<dim>(space, solution.u, comm),
                  tissue.cells(),
                  comm))
        throw StepFailed("a cell is turned inside out");
      return solution;
    }

  private:
    using TermList = typename MomentumBalance<dim>::TermList;
    using MassList = std::vector<typename RigidModes<dim>::Mass>;

    /** The parts that effects have in an attempt. */
    struct Parts
    {
      std::vector<std::unique_ptr<PartOfStep<dim>>> list;
      /** Those of the list that have something of their own, or null. */
      InteractionInStep<dim>                      *interaction = nullptr;
      typename MomentumBalance<dim>::EnclosureList enclosures  = {};
      /** As PartOfStep::is_exact() of any part. */
      bool is_exact = false;
    };

    Solution
    balance(const Attempt                    &attempt,
            const MaterialPoints<dim>        &points,
            NewtonReport                     &report,
            std::optional<ConditionEstimate> &condition) const
    {
      // This makes the terms of doc/theory.md (2.1), finds their equilibrium,
      // turn by turn (5.6), and reads the forces out of the terms. The parts of
      // effects keep references to the attempt, and come before the terms,
      // which may keep references to them.
      const AttemptAtStep<dim> of_parts = at_step(attempt, points);
      const Parts              parts    = this->parts(of_parts);
      const TermList           list     = terms(attempt, points, parts);
      MomentumBalance<dim>     balance(space,
                                   list,
                                   timer,
                                   comm,
                                   parts.enclosures,
                                   parts.interaction != nullptr ?
                                         &parts.interaction->pairs() :
                                         nullptr);
      const LinearProblem      linear =
        balance.linear_problem(attempt.typical_stiffness,
                               inertia(),
                               tissue.cells().size());
      // The estimate is made once a step, in its first attempt.
      if (model.scene.output.condition_estimate && !condition)
        {
          const TimerOutput::Scope section(timer, "condition estimate");
          condition = estimate_condition(balance, linear, balance.rest());
        }
      Solution solution{start(attempt).value_or(balance.rest()), {}, {}};
      const Equilibrium::Evaluation evaluation =
        find(attempt, parts, balance, linear, solution.u, report);
      const DisplacementField<dim> displacement(space, solution.u, comm);
      if (encounters != nullptr && !encounters->any())
        encounters->check(displacement);
      report.proximal_paths += attempt.drag > 1.;
      read_out(of_parts, list, parts, solution);
      if (model.boundary_conditions.has_dirichlet())
        check_gap(balance.largest_gap(evaluation),
                  model.scene.solver.largest_gap,
                  space.box().spacing());
      return solution;
    }

    /** The attempt as effects see it. */
    AttemptAtStep<dim>
    at_step(const Attempt &attempt, const MaterialPoints<dim> &points) const
    {
      return {tissue,
              space,
              model.material,
              attempt.growth,
              points,
              attempt.t,
              attempt.t_next,
              attempt.typical_stiffness,
              !attempt.halve_first,
              model.scene.solver.kernel,
              model.scene.solver.newton_tolerance,
              attempt.kept,
              timer,
              comm};
    }

    /** Keeps references to the attempt. */
    Parts
    parts(const AttemptAtStep<dim> &attempt) const
    {
      // The conditions' parts come in the order of the scene, then what may
      // meet.
      Parts parts;
      parts.list = model.boundary_conditions.parts_of_step(attempt);
      if (may_meet())
        {
          auto part         = encounters->part_of_step(attempt);
          parts.interaction = part.get();
          parts.list.push_back(std::move(part));
        }
      for (const auto &part : parts.list)
        {
          if (const auto *const enclosure = part->enclosure())
            parts.enclosures.push_back(enclosure);
          parts.is_exact = parts.is_exact || part->is_exact();
        }
      return parts;
    }

    /** The equilibrium, turn by turn, from u on. Collective. */
    Equilibrium::Evaluation
    find(const Attempt        &attempt,
         const Parts          &parts,
         MomentumBalance<dim> &balance,
         const LinearProblem  &linear,
         Equilibrium::Vector  &u,
         NewtonReport         &report) const
    {
      // The participants begin before the first residual needs what they hold
      // fixed. The report is completed for the diagnosis of a failed step, too.
      std::vector<TurnParticipant *> participants;
      for (const auto &part : parts.list)
        {
          part->begin(balance, u);
          participants.push_back(part.get());
        }
      // Newton's method needs no extremes of all ranks; the trace does.
      const std::size_t n_traced       = report.trace.size();
      const auto        share_extremes = [&]() {
        for (std::size_t i = n_traced; i < report.trace.size(); ++i)
          report.trace[i].evaluation.smallest_J =
            balance.smallest_J(report.trace[i].evaluation);
      };
      bool is_solved = false;
      try
        {
          const Equilibrium::Evaluation evaluation = balance_in_turns(
            balance,
            participants,
            [&](const Renewal &early) {
              is_solved                           = false;
              const Equilibrium::Evaluation found = find_in_turn(
                attempt, parts.is_exact, early, balance, linear, u, report);
              check_turn<dim>(tissue, space, {space, u, comm});
              is_solved = true;
              return found;
            },
            u,
            report);
          share_extremes();
          return evaluation;
        }
      catch (const StepFailed &failure)
        {
          share_extremes();
          Equilibrium::Vector R(u);
          report.failed_at            = balance.residual(u, R);
          report.failed_at.smallest_J = balance.smallest_J(report.failed_at);
          throw StepFailed(failure.what() + (". " + balance.describe(u)),
                           is_solved);
        }
    }

    /** Newton's method from u on, and a proximal path where it fails. */
    Equilibrium::Evaluation
    find_in_turn(const Attempt        &attempt,
                 const bool            is_exact,
                 const Renewal        &early,
                 MomentumBalance<dim> &balance,
                 const LinearProblem  &linear,
                 Equilibrium::Vector  &u,
                 NewtonReport         &report) const
    {
      // A step that is plainly too long is halved. All other failures have a
      // path to their equilibrium, as the energy has a lowest value
      // (doc/theory.md, section 5.9). Where folds have contact it goes step by
      // step: hold_back().
      const Equilibrium::Vector begin(u);
      NewtonScales scales = balance.scales(attempt.typical_stiffness);
      // In a later turn forces count as small beside those of the first one.
      if (report.place.turn > 1 && !is_exact)
        scales.small_force =
          std::max(scales.small_force, report.first_residual);
      // Where folds have contact, a turn of many iterations fails, as held back
      // it is easier; half a per cent of the forces is enough.
      SolverParameters parameters = model.scene.solver;
      const bool       has_parts  = tissue.cells().has_parts();
      if (has_parts)
        {
          scales.length *= 100.;
          parameters.newton_iterations =
            std::min(50u, parameters.newton_iterations.value());
        }
      const OnTheWay on_the_way{[this](const auto &state) {
                                  check_turn<dim>(tissue,
                                                  space,
                                                  {space, state, comm});
                                },
                                early};
      try
        {
          return Morula::solve(
            balance, linear, scales, parameters, timer, u, report, on_the_way);
        }
      catch (const StepFailed &)
        {
          if (has_parts || (attempt.halve_first && !report.ends_at_leap &&
                            balance.is_far_from(begin, u)))
            throw;
          u = begin; // as it may be anywhere
          return follow_proximal_path(
            balance, linear, scales, model.scene.solver, timer, u, report);
        }
    }

    /** What the step keeps, and the forces on the surface, if conditions act on
     *  it. Collective. */
    void
    read_out(const AttemptAtStep<dim> &attempt,
             const TermList           &list,
             const Parts              &parts,
             Solution                 &solution) const
    {
      // The next step sees what belongs to the equilibrium that was found last.
      for (const auto &part : parts.list)
        part->keep(solution.kept);
      if (model.boundary_conditions.list().empty() && encounters == nullptr)
        return;
      const TimerOutput::Scope section(timer, "forces");
      solution.forces = surface_forces(
        model, attempt, solution.u, list, parts.list, parts.interaction);
    }

    /** Where Newton's iterations begin; nothing if they begin at u = 0. */
    std::optional<Equilibrium::Vector>
    start(const Attempt &attempt) const
    {
      // Where a clamp moves the tissue goes along from the start, doc/theory.md
      // (4.14): from u = 0 Newton's method may fail if it moves by h.
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

    /** Vectors that keep rigid motions without support out of the step. */
    std::vector<Equilibrium::Vector>
    inertia() const
    {
      // Obstacles may hold motions that no support is known of before the step.
      // With them nothing is projected out, and the weak drag (4.8f) decides
      // instead of (4.10). Other bodies may hold all motions but those that
      // all bodies make together, doc/theory.md (4.10a). Those have to be held:
      // with frozen normals a common rotation has a negative stiffness.
      if (!rigid_modes.any() || model.boundary_conditions.has_pushing())
        return {};
      const TimerOutput::Scope section(timer, "rigid motion");
      if (may_meet())
        return RigidModes<dim>(space, masses(), supports, comm, true)
          .inertia(masses());
      return rigid_modes.inertia(masses());
    }

    TermList
    terms(const Attempt             &attempt,
          const MaterialPoints<dim> &points,
          const Parts               &parts) const
    {
      // The list has the terms of doc/theory.md (2.1): the stress of the cells
      // first, then forces on cells, held points (4.2) or (4.6a), and loads.
      // surface_forces() relies on this order. All loads are taken at t + dt,
      // while readers of cells see the state at t. Where something may meet, a
      // weak drag decides where pieces go that nothing else holds (4.8f).
      const double t = attempt.t_next;
      TermList     list;
      list.push_back(internal_force(points,
                                    model.material.volumetric_form(),
                                    model.scene.solver.kernel));
      // Expressions may have no value at this time on some ranks; all ranks
      // must then throw together.
      const auto add = [&](const std::string &name, const auto &make) {
        const TimerOutput::Scope section(timer, name);
        everywhere(comm, [&]() { list.push_back(make()); });
      };
      for (const auto &named : model.forces)
        add(named.name, [&]() {
          return named.effect->term(tissue,
                                    model.development.reader(attempt.t),
                                    cell_positions(tissue, space),
                                    attempt.t,
                                    t);
        });
      for (const auto &part : parts.list)
        if (auto term = part->term())
          list.push_back(std::move(term));
      if (model.boundary_conditions.has_dirichlet() &&
          model.boundary_conditions.nitsche().kind() != NitscheForm::bounded)
        add("nitsche", [&]() {
          return nitsche_term(model.boundary_conditions,
                              model.material,
                              tissue,
                              space,
                              attempt.growth,
                              t,
                              model.scene.solver.kernel);
        });
      add_loads(attempt, list);
      if (parts.interaction != nullptr || attempt.drag > 1.)
        {
          const TimerOutput::Scope section(timer, model.interaction->name);
          auto                     drag = weak_drag(attempt.typical_stiffness);
          drag->set_strength(attempt.drag);
          if (parts.interaction != nullptr)
            parts.interaction->take_drag(*drag, attempt.drag == 1.);
          list.push_back(std::move(drag));
        }
      return list;
    }

    /** Adds the terms of the conditions that load the surface. @throws
     *  StepFailed on all ranks if a condition finds the step too long */
    void
    add_loads(const Attempt &attempt, TermList &list) const
    {
      const BoundaryConditions<dim> &conditions = model.boundary_conditions;
      if (!conditions.has(SurfaceCondition::loaded))
        return;
      // The groups of loaded points are shared by all conditions and made by
      // the first of them, inside its section of the timer. A condition that
      // does nothing at this time gives no term.
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
      if (conditions.has_pushing() && !may_meet())
        list.push_back(weak_drag(attempt.typical_stiffness));
    }

    /** Whether something may meet in the step. */
    bool
    may_meet() const
    {
      return encounters != nullptr && encounters->any();
    }

    /** A drag that is too weak to matter elsewhere. It decides where pieces go
     *  that loads push and nothing holds: doc/theory.md (4.8f). */
    std::unique_ptr<Drag<dim>>
    weak_drag(const double typical_stiffness) const
    {
      // This is doc/theory.md (4.8f) with one stiffness η V⁰ for each cell, in
      // the order of cell_positions().
      const double        h   = space.box().spacing();
      const double        eta = Drag<dim>::least * typical_stiffness / (h * h);
      std::vector<double> stiffnesses;
      for (unsigned int p = 0; p < tissue.cells().size(); ++p)
        stiffnesses.push_back(eta * tissue.cells().initial_volume(p));
      return std::make_unique<Drag<dim>>(cell_positions(tissue, space),
                                         std::move(stiffnesses));
    }

    MassList
    masses() const
    {
      // The cells stand in the order of their grid cells. The piece of a grid
      // cell is that of all its cells, so that each piece gets its own rigid
      // motions.
      const Cells<dim> &cells = tissue.cells();
      MassList          list;
      for (const auto &grid_cell : cells.grid_cells())
        for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
          list.push_back({space.piece(grid_cell.number, grid_cell.part),
                          cells.position(p),
                          cells.initial_volume(p)});
      return list;
    }

    const TissueModel<dim> &model;
    const Tissue<dim>      &tissue;
    const SplineSpace<dim> &space;
    TimerOutput            &timer;
    const MPI_Comm          comm;
    const Supports         &supports;
    const RigidModes<dim>   rigid_modes;

    const Encounters<dim> *const encounters;
  };


  template <int dim>
  StepEquilibrium<dim>::StepEquilibrium(const TissueModel<dim> &model,
                                        const Tissue<dim>      &tissue,
                                        const SplineSpace<dim> &space,
                                        const Supports         &supports,
                                        TimerOutput            &timer,
                                        const MPI_Comm          comm,
                                        const Encounters<dim>  *encounters)
    : work(std::make_unique<const Work>(
        model, tissue, space, supports, timer, comm, encounters))
  {}


  template <int dim>
  StepEquilibrium<dim>::~StepEquilibrium() = default;


  template <int dim>
  typename StepEquilibrium<dim>::Solution
  StepEquilibrium<dim>::solve(const Attempt                    &attempt,
                              NewtonReport                     &report,
                              std::optional<ConditionEstimate> &condition) const
  {
    return work->solve(attempt, report, condition);
  }


  template class StepEquilibrium<2>;
  template class StepEquilibrium<3>;
} // namespace Morula
