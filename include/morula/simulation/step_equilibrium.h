// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_step_equilibrium_h
#define morula_simulation_step_equilibrium_h

#include <morula/effects/interaction.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/mechanics/point_term.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/scene/tissue_model.h>
#include <morula/simulation/surface_forces.h>
#include <morula/solver/condition_estimate.h>
#include <morula/solver/newton.h>

#include <deal.II/base/timer.h>

#include <optional>

namespace Morula
{
  /**
   * The equilibrium of a step: the sum of the scene's terms on the splines of
   * one configuration, and its solution, in as many attempts as the step takes.
   * Keeps references to all that it is given.
   */
  template <int dim>
  class StepEquilibrium
  {
  public:
    /** One attempt at a step. */
    struct Attempt
    {
      double                        t, t_next; // day
      const DevelopmentOfStep<dim> &growth;
      double                        typical_stiffness; // kPa
      /** What outlives a step, as it was before. */
      const NamedNumbers &kept;
      /** Whether half the step is to be tried, before a proximal path, where
       * the step is plainly too long. */
      bool halve_first = true;
      /** The drag that holds the tissue back: slow_steps.h. */
      double drag = 1.;
    };

    /** What was found for a step. */
    struct Solution
    {
      Equilibrium::Vector u;      // displacement, µm
      NamedNumbers        kept;   // what the step has changed of it
      SurfaceForces<dim>  forces; // at its end
    };

    using Supports = std::vector<typename RigidModes<dim>::Support>;

    /** @param supports what holds this rank's pieces
     *  @param encounters what may meet, or null. Collective. */
    StepEquilibrium(const TissueModel<dim> &model,
                    const Tissue<dim>      &tissue,
                    const SplineSpace<dim> &space,
                    const Supports         &supports,
                    TimerOutput            &timer,
                    const MPI_Comm          comm,
                    const Encounters<dim>  *encounters = nullptr);

    /**
     * Solves for the end of a step. Collective.
     * @param report in/out: this attempt's work is added
     * @param condition in/out: set for the first tangent, if the scene asks for
     * it and it is not known yet
     * @throws StepFailed, InputError on all ranks together
     */
    Solution
    solve(const Attempt                    &attempt,
          NewtonReport                     &report,
          std::optional<ConditionEstimate> &condition) const;

  private:
    using TermList = typename MomentumBalance<dim>::TermList;
    using MassList = std::vector<typename RigidModes<dim>::Mass>;

    /** The parts that effects have in an attempt. */
    struct Parts
    {
      std::vector<std::unique_ptr<PartOfStep<dim>>> list;
      /** Those of the list that have something of their own, or null. */
      InteractionInStep<dim> *meeting   = nullptr;
      Enclosure<dim>         *enclosure = nullptr;
      /** As PartOfStep::is_exact() of any part. */
      bool is_exact = false;
    };

    Solution
    balance(const Attempt                    &attempt,
            const MaterialPoints<dim>        &points,
            NewtonReport                     &report,
            std::optional<ConditionEstimate> &condition) const;
    /** The attempt as effects see it. */
    AttemptAtStep<dim>
    at_step(const Attempt &attempt) const;
    /** Keeps references to the attempt. */
    Parts
    parts(const AttemptAtStep<dim> &attempt) const;
    /** The equilibrium, turn by turn, from u on. Collective. */
    Equilibrium::Evaluation
    find(const Attempt        &attempt,
         const Parts          &parts,
         MomentumBalance<dim> &balance,
         const LinearProblem  &linear,
         Equilibrium::Vector  &u,
         NewtonReport         &report) const;
    /** Newton's method from u on, and a proximal path where it fails. */
    Equilibrium::Evaluation
    find_in_turn(const Attempt        &attempt,
                 const bool            is_exact,
                 MomentumBalance<dim> &balance,
                 const LinearProblem  &linear,
                 Equilibrium::Vector  &u,
                 NewtonReport         &report) const;
    /** What the step keeps, and the forces on the surface, if conditions act on
     *  it. Collective. */
    void
    read_out(const Attempt  &attempt,
             const TermList &list,
             const Parts    &parts,
             Solution       &solution) const;
    /** Where Newton's iterations begin; nothing if they begin at u = 0. */
    std::optional<Equilibrium::Vector>
    start(const Attempt &attempt) const;
    void
    estimate_condition(MomentumBalance<dim>             &balance,
                       const LinearProblem              &linear,
                       std::optional<ConditionEstimate> &condition) const;
    /** Vectors that keep rigid motions without support out of the step. */
    std::vector<Equilibrium::Vector>
    inertia() const;

    TermList
    terms(const Attempt             &attempt,
          const MaterialPoints<dim> &points,
          const Parts               &parts) const;
    /** Adds the terms of the conditions that load the surface. @throws
     *  StepFailed on all ranks if a condition finds the step too long */
    void
    add_loads(const Attempt &attempt, TermList &list) const;
    /** Whether something may meet in the step. */
    bool
    may_meet() const
    {
      return encounters != nullptr && encounters->any();
    }

    /** A drag that is too weak to matter elsewhere. It decides where pieces go
     *  that loads push and nothing holds: doc/theory.md (4.8f). */
    std::unique_ptr<Drag<dim>>
    weak_drag(const double typical_stiffness) const;
    MassList
    masses() const;

    const TissueModel<dim> &model;
    const Tissue<dim>      &tissue;
    const SplineSpace<dim> &space;
    TimerOutput            &timer;
    const MPI_Comm          comm;
    const RigidModes<dim>   rigid_modes;

    const Encounters<dim> *const encounters;
  };
} // namespace Morula

#endif
