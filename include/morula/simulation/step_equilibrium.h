// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_step_equilibrium_h
#define morula_simulation_step_equilibrium_h

#include <morula/effects/interaction.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/mechanics/momentum_balance.h>
#include <morula/mechanics/point_term.h>
#include <morula/mechanics/rigid_modes.h>
#include <morula/mechanics/spline_field.h>
#include <morula/mechanics/term.h>
#include <morula/output/rows.h>
#include <morula/particles/tissue.h>
#include <morula/scene/tissue_model.h>
#include <morula/solver/condition_estimate.h>
#include <morula/solver/newton.h>

#include <deal.II/base/timer.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace Morula
{
  /** What conditions and forces do to the tissue at the end of a step. */
  template <int dim>
  struct SurfaceForces
  {
    /** The rows of forces.csv: they are equal on all ranks. */
    std::vector<ForceRow> rows;
    /** The sum of all conditions' forces on each of this rank's boundary
     * points, in the order of the store, kPa µm^(dim-1). */
    std::vector<Tensor<1, dim>> of_points;
    /** The pressure there of what touches, kPa: the normal force on the points
     *  of their body within half a grid spacing over the area of these. The
     *  pressure of single points is no measure of accuracy, as facets of two
     *  surfaces do not match. Empty where nothing touches. */
    std::vector<double> contact_pressures;
  };

  /** Gives the boundary points their forces and the pressure of contact, if
   * they have columns for them. */
  template <int dim>
  void
  set_forces(const SurfaceForces<dim> &forces, Tissue<dim> &tissue);

  /**
   * Adds up the forces at the end of a step with this displacement, point by
   * point. They are those of the terms in whose sum Newton's method has found
   * the equilibrium.
   * Keeps references to all that it is given.
   */
  template <int dim>
  class ForceSums
  {
  public:
    /** @param tissue at the beginning of the step, as @p space. Collective. */
    ForceSums(const Tissue<dim>                   &tissue,
              const SplineSpace<dim>              &space,
              const TrilinosWrappers::MPI::Vector &u,
              const MPI_Comm                       comm);

    /** Adds a row for a force on the cells. Any term will do, as the row is a
     * sum over splines. */
    void
    add_force(const std::string &name, const Term<dim> &term);

    /** Adds a row for each condition that holds points, with the points at
     * which it wins. */
    void
    add_held(const BoundaryConditions<dim> &conditions, const Term<dim> &term);

    /** Adds rows for the conditions that load the surface, at the end @p t
     * (day) of the step. */
    void
    add_loads(const BoundaryConditions<dim> &conditions,
              const LoadedPoints<dim>       &points,
              const double                   t);

    /** Adds a row for a force that an effect has as a whole. */
    void
    add_part(const ForceOnPoints<dim> &force);

    /** Adds a row of this kind for each two bodies that touch, with the force
     *  of the one with the lower number on the other, and the pressure at all
     *  points. Collective. */
    void
    add_between(const std::string                    &kind,
                const std::vector<ForceBetween<dim>> &forces);

    /** The rows as sums over all ranks, and this rank's forces of points.
     *  Collective. */
    SurfaceForces<dim>
    result() const;

  private:
    /** Adds a row for the points of @p groups for which selects(p, force)
     * holds.
     *  @param term of all of these points */
    void
    add_row(
      const std::string                                               &kind,
      const std::string                                               &name,
      const PointGroups                                               &groups,
      const Term<dim>                                                 &term,
      const double                                                     factor,
      const std::function<bool(unsigned int, const Tensor<1, dim> &)> &selects);

    const Tissue<dim>           &tissue;
    const SplineSpace<dim>      &space;
    const DisplacementField<dim> displacement;
    const MPI_Comm               comm;
    SurfaceForces<dim>           mine; // of this rank
  };

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

    struct Parts; // that effects have in an attempt

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
