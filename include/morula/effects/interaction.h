// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_interaction_h
#define morula_effects_interaction_h

#include <morula/effects/part_of_step.h>
#include <morula/mechanics/point_term.h>
#include <morula/mechanics/term.h>
#include <morula/particles/fusion.h>

#include <memory>
#include <string>
#include <vector>

namespace Morula
{
  /** What tissue of another side does to a boundary point. */
  template <int dim>
  struct ForceBetween
  {
    unsigned int   p;      // number of the point
    unsigned int   body;   // of the point
    unsigned int   other;  // body
    Tensor<1, dim> force;  // on the point, kPa µm^(dim-1)
    double         normal; // its part that presses, kPa µm^(dim-1)
    Point<dim>     place;  // where it acts, µm
  };

  /** An interaction in an attempt at a step. */
  template <int dim>
  class InteractionInStep : public PartOfStep<dim>
  {
  public:
    /** Its term. Lives as long as this part. */
    virtual PairTerm &
    pairs() = 0;

    /** Takes the drag of the step, which acts on all cells where something may
     *  meet, and lives as long as this part; and whether it is weak: it only
     *  decides then where pieces go that nothing holds. */
    virtual void
    take_drag(Drag<dim> & /*drag*/, const bool /*is_weak*/)
    {}

    /** The forces of the pairs on this rank's boundary points in the
     *  equilibrium @p u, in the order of the store. */
    virtual std::vector<ForceBetween<dim>>
    forces(const Equilibrium::Vector &u) const = 0;
  };

  /** What may meet in the steps that begin with one configuration. All members
   *  but any() are collective. */
  template <int dim>
  class Encounters
  {
  public:
    virtual ~Encounters() = default;

    /** Whether anything may act in a step, on any rank. */
    virtual bool
    any() const = 0;

    /** The part in an attempt at a step, if any(). Keeps a reference to it. */
    virtual std::unique_ptr<InteractionInStep<dim>>
    part_of_step(const AttemptAtStep<dim> &attempt) const = 0;

    /** Refuses a step in which something has met that is none of these.
     *  @throws StepFailed */
    virtual void
    check(const DisplacementField<dim> & /*displacement*/) const
    {}
  };

  /**
   * What bodies do to each other across the gap between their surfaces, and
   * folds of a body to each other: such tissue shares no splines. A scene has
   * one interaction at most.
   */
  template <int dim>
  class Interaction : public Effect<dim>
  {
  public:
    /** Whether all cells of a type are a body; else it is cells that stand
     *  together at t = 0. */
    virtual bool
    takes_types_as_bodies() const
    {
      return false;
    }

    /** Whether a body can meet itself, too. */
    virtual bool
    acts_within_bodies() const
    {
      return false;
    }

    /** Whether equations go on from body to body where these are within a grid
     *  spacing of each other. */
    virtual bool
    lets_equations_pass() const
    {
      return true;
    }

    /** Refuses bodies that it cannot hold apart, in the order of their numbers.
     *  @throws InputError */
    virtual void
    check_bodies(const std::vector<BodyMeasures> &, const SceneKeys &) const
    {}

    /** Adds warnings about these bodies. */
    virtual void
    review_bodies(const std::vector<BodyMeasures> &,
                  std::vector<std::string> & /*warnings*/) const
    {}

    /** How it acts on these bodies with this grid spacing (µm), for --explain.
     */
    virtual std::string
    details_of_bodies(const std::vector<BodyMeasures> &,
                      const double /*h*/) const
    {
      return "";
    }

    /** What may meet. Collective. @param space of the configuration; unknowns
     *  of other ranks may become relevant in it */
    virtual std::unique_ptr<const Encounters<dim>>
    encounters(const Tissue<dim> &tissue, SplineSpace<dim> &space) const = 0;

    /** Whether bodies may become one. */
    virtual bool
    fuses() const
    {
      return false;
    }

    /** What becomes one at the end of a step of @p dt days; called once a step
     *  if fuses(). Collective. */
    virtual Fusion
    fusion(Tissue<dim> & /*tissue*/, const double /*dt*/) const
    {
      return {};
    }
  };
} // namespace Morula

#endif
