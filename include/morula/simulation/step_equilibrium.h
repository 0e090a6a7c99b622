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

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
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
    /** What other sides do to them. */
    std::vector<ForceBetween<dim>> between;
    /** The numbers of the rows of bodies that touch, by both of them. */
    std::map<std::pair<unsigned int, unsigned int>, std::size_t> touching;
  };

  /** Gives the boundary points, which have their new areas and stand where they
   *  stood at t, their forces and the pressure of contact, if they have columns
   *  for them. Collective. @return the rows, with the area of each contact */
  template <int dim>
  std::vector<ForceRow>
  set_forces(const SurfaceForces<dim> &forces, Tissue<dim> &tissue);

  /**
   * The forces at the end of a step with the displacement @p u, point by point.
   * They are those of the terms in whose sum Newton's method has found the
   * equilibrium: the stress of the cells, the forces on cells, the held points
   * and others, in this order. Collective.
   * @param attempt that has succeeded
   * @param parts   of effects in it
   * @param interaction the one of what may meet, or null
   */
  template <int dim>
  SurfaceForces<dim>
  surface_forces(const TissueModel<dim>                              &model,
                 const AttemptAtStep<dim>                            &attempt,
                 const Equilibrium::Vector                           &u,
                 const std::vector<std::unique_ptr<Term<dim>>>       &terms,
                 const std::vector<std::unique_ptr<PartOfStep<dim>>> &parts,
                 const InteractionInStep<dim> *interaction);

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
       *  the step is plainly too long. */
      bool halve_first = true;
      /** The drag that holds the tissue back: TimeSteps::hold_back(). */
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

    ~StepEquilibrium();

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
    class Work;
    std::unique_ptr<const Work> work;
  };
} // namespace Morula

#endif
