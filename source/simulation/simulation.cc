// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/effects/surface/boundary_terms.h>
#include <morula/mechanics/point_term.h>
#include <morula/particles/detached_points.h>
#include <morula/simulation/simulation.h>
#include <morula/simulation/step_checks.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

// One step.

namespace Morula
{
  namespace
  {
    /** The number of times that a plainly too long step is halved before a
     * proximal path is tried. An eighth of such a step hardly is too long any
     * more: if it fails too, something jumps (doc/theory.md, section 5.9). */
    constexpr unsigned int most_plain_halves = 3;


    /**
     * What holds the pieces of this rank in a step from @p t to @p t_next
     * (day): fixed and slip points, and cells with friction that is not too
     * weak to decide where a free piece goes. Not collective.
     * @throws InputError if an expression has no value
     */
    template <int dim>
    std::vector<typename RigidModes<dim>::Support>
    step_supports(const TissueModel<dim> &model,
                  const Tissue<dim>      &tissue,
                  const SplineSpace<dim> &space,
                  const double            t,
                  const double            t_next)
    {
      // Held points come first, then cells with friction, each with its weight
      // in the matrix S of doc/theory.md (4.9) and section 4.4. Friction holds
      // all directions (M = I). If ζh²/(E Δt) is below the least drag rounding
      // would decide where a free piece goes; it then counts as none. Each rank
      // lists what lies in its own grid cells; RigidModes adds the lists up.
      auto         list = supports(model.boundary_conditions, tissue, space);
      const double h    = space.box().spacing();
      const Cells<dim>      &cells  = tissue.cells();
      const CellReader<dim> &reader = model.development.reader(t);
      for (const auto &named : model.forces)
        {
          const std::vector<double> friction =
            named.effect->friction(tissue, reader, t);
          // The list is empty for a force without friction.
          if (friction.empty())
            continue;
          for (const auto &grid_cell : cells.grid_cells())
            for (unsigned int p = grid_cell.begin; p < grid_cell.end; ++p)
              {
                const double stiffness =
                  youngs_modulus(present_cell(tissue, p, reader).lame());
                const double strength =
                  friction[p] * h * h / ((t_next - t) * stiffness);
                if (strength >= Drag<dim>::least)
                  list.push_back({space.piece(grid_cell.number, grid_cell.part),
                                  cells.position(p),
                                  Tensor<2, dim>(unit_symmetric_tensor<dim>()),
                                  strength * cells.initial_volume(p) / h});
              }
        }
      return list;
    }
  } // namespace


  template <int dim>
  void
  Simulation<dim>::step()
  {
    // A step has three parts. Up to solve_step() the tissue does not move: the
    // configuration at t has its splines and its steady fields, and the
    // displacement is sought on them. move() brings the tissue to t + dt, after
    // which a failure can no longer be answered by half the step. rearrange()
    // acts on the moved tissue. Most of these calls are collective, so that all
    // ranks make all of them.
    begin_step();
    // Encounters change the places of unknowns, so that they come before all
    // that keeps these.
    SplineSpace<dim>                      space      = splines();
    const auto                            encounters = this->encounters(space);
    const std::optional<SplineSpace<dim>> unparted =
      splines_of_equations(space);
    const SplineSpace<dim> &space_of_equations = unparted ? *unparted : space;
    watch(space);
    // The fields of t = 0 are known already: begin() needs them for the first
    // row of statistics.csv.
    if (run_state.n_steps > 1)
      settle_equations(space_of_equations);
    // The length of the step has to be known before growth is computed for it,
    // but after the fields, as growth may depend on them.
    adapt_step();
    const auto solution = solve_step(space, encounters.get());
    move(space, space_of_equations, solution);
    rearrange(space);
    complete_row();
  }


  template <int dim>
  bool
  Simulation<dim>::balance_at_start()
  {
    // This is a step of no length, in which nothing grows or flows. Without it
    // a load that is there at t = 0 would first be felt at the end of the first
    // step, and what cells do in a step follows their state at its beginning.
    // Where the balance is not found, as with friction, which lets nothing move
    // in no time, the first step finds it. Nothing moves where nothing acts.
    const auto &conditions = model.boundary_conditions.list();
    if (model.scene.method == "paper" || !model.development.follows_strain() ||
        (model.forces.empty() &&
         std::none_of(
           conditions.begin(), conditions.end(), [](const auto &named) {
             return named.condition->moves() && !named.condition->only_pushes();
           })))
      return false;
    for (const auto &named : conditions)
      named.condition->touch(tissue, 0.);
    SplineSpace<dim>                 space      = splines();
    const auto                       encounters = this->encounters(space);
    const double                     t          = time_steps.time();
    NewtonReport                     report;
    std::optional<ConditionEstimate> none = ConditionEstimate();
    std::optional<typename StepEquilibrium<dim>::Solution> solution;
    if (model.material.depends_on_state())
      {
        const CellReader<dim> reader = model.development.reader(t);
        everywhere(comm, [&]() {
          for (unsigned int p = 0; p < tissue.cells().size(); ++p)
            growth_of_step.lame.push_back(
              present_cell(tissue, p, reader).lame());
        });
        typical_stiffness =
          model.typical_stiffness(tissue, growth_of_step, comm);
      }
    try
      {
        const auto supports =
          Morula::supports(model.boundary_conditions, tissue, space);
        solution =
          StepEquilibrium<dim>(
            model, tissue, space, supports, timer, comm, encounters.get())
            .solve({t, t, growth_of_step, typical_stiffness, run_state.kept},
                   report,
                   none);
      }
    catch (const StepFailed &)
      {}
    const bool moves = solution && solution->u.linfty_norm() > 0.;
    if (moves)
      {
        commit(space, space, *solution, false);
        forces.clear(); // their first row is that of a step
        if (surface.is_tracked())
          pull_back_detached_points(tissue);
        surface.follow(tissue, space, surface.before_losses(tissue), t, 0.);
        renew_carriers(tissue);
        for_moments(&Moments<dim>::surfaced, t, 0.);
        for_moments(&Moments<dim>::after, t, 0.);
      }
    growth_of_step = {};
    first_splines.emplace(splines());
    return moves;
  }


  template <int dim>
  void
  Simulation<dim>::begin_step()
  {
    row                            = StatisticsRow();
    newton_report                  = NewtonReport();
    newton_report.wants_trace      = model.scene.output.newton_trace;
    newton_report.before_iteration = [this]() { stop_if_asked(); };
    of_step                        = {};
    births                         = {};
    events                         = {};
    ++run_state.n_steps;
    for (const auto &equation : equations)
      equation->begin_step();
    for (const auto &named : model.boundary_conditions.list())
      named.condition->touch(tissue, time_steps.time());
  }


  template <int dim>
  void
  Simulation<dim>::move(const SplineSpace<dim> &space,
                        const SplineSpace<dim> &space_of_equations,
                        const typename StepEquilibrium<dim>::Solution &solution)
  {
    const DisplacementField<dim> displacement(space, solution.u, comm);
    warn_of_turn(space, displacement);
    // How far a strand turns that was held back tells how it is held on.
    double turn = 0.;
    if (time_steps.state().drag > 1.)
      for (turn = 1.; turn > 0.25 &&
                      !turns_too_far(tissue, space, displacement, 0.5 * turn);)
        turn *= 0.5;
    // commit() empties growth_of_step, so what the step before missed of growth
    // is read here.
    const double missed_growth = mean_missed(growth_of_step.missed_growth);
    commit(space, space_of_equations, solution);
    run_state.error.template add<dim>(missed_growth);
    // The displacement is extrapolated beyond the outermost cells and carries
    // boundary points away there, doc/theory.md (4.13). A surface that is made
    // from the cells is never far from them.
    if (surface.is_tracked())
      {
        const TimerOutput::Scope section(timer, "strays");
        pull_back_detached_points(tissue);
      }
    row.dt = time_steps.next() - time_steps.time();
    time_steps.accept(turn);
  }


  template <int dim>
  void
  Simulation<dim>::adapt_step()
  {
    if (model.scene.time.tolerance <= 0.)
      return;
    const TimerOutput::Scope section(timer, "growth");
    // Each rank evaluates its own cells and may meet an expression without a
    // value; everywhere() lets all ranks throw then. mean_missed() makes one
    // number of all ranks' cells, so that all of them choose the same length.
    // What was missed of flow is known since the end of the last step.
    std::vector<double> missed;
    everywhere(comm, [&]() {
      missed = model.development.missed_growth(tissue,
                                               time_steps.time(),
                                               time_steps.past());
    });
    time_steps.adapt(run_state.error.flow + mean_missed(missed));
  }

  template <int dim>
  SplineSpace<dim>
  Simulation<dim>::splines()
  {
    if (first_splines)
      {
        // begin() has made these splines for the first row, and the cells have
        // not moved since then.
        SplineSpace<dim> space = std::move(*first_splines);
        first_splines.reset();
        return space;
      }
    const TimerOutput::Scope section(timer, "grid");
    // A step holds the least memory here, before its matrix exists.
    tissue.defragment();
    tissue.part();
    // Where volumes are pooled, points on grid lines belong to all grid cells
    // around (doc/theory.md, section 2.4).
    return tissue.splines(model.material.volumetric_form() !=
                          VolumetricStrain::pointwise);
  }

  template <int dim>
  double
  Simulation<dim>::friction_over_stiffness() const
  {
    // A stiffness that depends on the state of cells is known of a step.
    double largest = 0.;
    for (const auto &force : model.forces)
      for (const double zeta :
           force.effect->friction(tissue, model.development.reader(0.), 0.))
        largest = std::max(largest, zeta);
    return Utilities::MPI::max(largest, comm) /
           model.typical_stiffness(
             tissue,
             model.development.of_step(
               tissue, 0., model.scene.time.step, PastStep()),
             comm);
  }

  template <int dim>
  double
  Simulation<dim>::mixed_share()
  {
    // Who is alike is known of a step: it follows from stiffness and
    // relaxation.
    const Pools pools =
      material_points(tissue,
                      splines(),
                      model.development.of_step(
                        tissue, 0., model.scene.time.step, PastStep()),
                      model.material)
        .pools;
    double sums[2] = {0., 0.}; // of mixed pools, of all
    for (const Pool &pool : pools.list)
      for (unsigned int g = pool.first_group; g < pool.last_group; ++g)
        {
          const double grown = pools.groups[g].grown.before;
          sums[1] += grown;
          if (pool.last_group - pool.first_group > 1)
            sums[0] += grown;
        }
    Utilities::MPI::sum(sums, comm, sums);
    return sums[1] > 0. ? sums[0] / sums[1] : 0.;
  }

  template <int dim>
  typename StepEquilibrium<dim>::Solution
  Simulation<dim>::solve_step(const SplineSpace<dim> &space,
                              const Encounters<dim>  *encounters)
  {
    // The loop halves the step until an attempt succeeds. What does not depend
    // on the step's length (the supports of rigid motions, the splines) is made
    // once before it; StepFailed arrives on all ranks together, so that all go
    // round the loop equally often. The inner try block sees failures that a
    // shorter step can cure, the outer one those of the scene, which end the
    // run.
    try
      {
        typename StepEquilibrium<dim>::Supports supports;
        everywhere(comm, [&]() {
          supports = step_supports(
            model, tissue, space, time_steps.time(), time_steps.next());
        });
        const StepEquilibrium<dim> equilibrium(
          model, tissue, space, supports, timer, comm, encounters);
        while (true)
          try
            {
              newton_report.first_residual = newton_report.curvature = 0.;
              return try_step(equilibrium);
            }
          catch (const StepFailed &failure)
            {
              // Whether half a step begins with half the unbalanced force tells
              // in the end why the step failed; so the first attempt is
              // remembered.
              if (row.rejected_steps == 0)
                first_attempt = {time_steps.next() - time_steps.time(),
                                 newton_report.first_residual};
              ++row.rejected_steps;
              ++run_state.n_rejected;
              ++newton_report.place.attempt;
              if (tissue.cells().has_parts() &&
                  time_steps.hold_back(failure.is_too_long))
                continue;
              if (!time_steps.reject())
                give_up_step(failure.what());
            }
      }
    catch (const InputError &error)
      {
        // An expression has no value at this time.
        give_up(model.scene.located(error.what()));
      }
  }

  template <int dim>
  typename StepEquilibrium<dim>::Solution
  Simulation<dim>::try_step(const StepEquilibrium<dim> &equilibrium)
  {
    // Growth is known before the equilibrium is sought (doc/theory.md, section
    // 6), and depends on the length of the step: it is computed anew in each
    // attempt and committed only with the one that succeeds.
    const double t = time_steps.time(), t_next = time_steps.next();
    if (model.development.present())
      {
        const TimerOutput::Scope section(timer, "growth");
        growth_of_step =
          model.development.of_step(tissue, t, t_next, time_steps.past());
        // The stiffness is taken from the cells as they are in this step, since
        // a resumed run knows no earlier ones and has to find the same value.
        if (model.material.depends_on_state())
          typical_stiffness =
            model.typical_stiffness(tissue, growth_of_step, comm);
      }
    return equilibrium.solve({t,
                              t_next,
                              growth_of_step,
                              typical_stiffness,
                              run_state.kept,
                              time_steps.can_halve() &&
                                time_steps.state().level < most_plain_halves,
                              time_steps.state().drag},
                             newton_report,
                             condition);
  }

  template <int dim>
  void
  Simulation<dim>::solve_equations(
    const std::function<void(EquationInRun<dim> &)> &solve)
  {
    // Before the first step no state is worth saving, and an invalid expression
    // is an error of the input. Later the last good state is saved before the
    // run ends.
    const bool has_begun = run_state.n_steps > 0;
    try
      {
        for (const auto &equation : equations)
          solve(*equation);
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

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace Morula
