// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_boundary_conditions_h
#define morula_effects_surface_boundary_conditions_h

#include <morula/effects/surface/boundary_condition.h>
#include <morula/effects/surface/nitsche.h>
#include <morula/particles/boundary_state.h>

#include <memory>
#include <string>
#include <vector>

namespace Morula
{
  /** The scene's conditions on the surface: decides which one wins. */
  template <int dim>
  class BoundaryConditions
  {
  public:
    /** A condition and what it is called. */
    struct Named
    {
      std::string                                   name;
      std::unique_ptr<const BoundaryCondition<dim>> condition;
    };

    /** @param list in the order in which they were added */
    BoundaryConditions(std::vector<Named>       list,
                       const NitscheParameters &parameters);

    /** What the winning condition does to the point with initial position
     *  @p X (µm) and initial normal @p N; asked at t = 0. */
    SurfaceCondition
    condition(const Point<dim> &X, const Tensor<1, dim> &N) const;

    /**
     * The number in list() of the condition that wins at such a point, list()
     * .size() if none acts. Of several that load, the first is named.
     */
    unsigned int
    winner(const Point<dim> &X, const Tensor<1, dim> &N) const;

    /**
     * Prescribed displacement of a fixed point, µm. @p X_seed decides which
     * condition fixes it: the initial position of the point at t = 0 of which
     * this one is a part.
     */
    Tensor<1, dim>
    displacement(const Point<dim>     &X_seed,
                 const Tensor<1, dim> &N,
                 const Point<dim>     &X,
                 const double          t) const;

    /** Whether the same conditions act on two points. That is decided at the
     *  points at t = 0 of which they are parts. */
    bool
    alike(const BoundaryView<dim> &a, const BoundaryView<dim> &b) const;

    /** Whether the scene has conditions that fix or let slip. */
    bool
    has_dirichlet() const
    {
      return has(SurfaceCondition::fixed) || has(SurfaceCondition::slip);
    }

    /** Whether one of this kind exists. */
    bool
    has(const SurfaceCondition kind) const;

    /** Whether a condition only pushes. */
    bool
    has_pushing() const;

    /** What conditions besides their terms have in an attempt at a step, to
     *  which references are kept. Collective. */
    std::vector<std::unique_ptr<PartOfStep<dim>>>
    parts_of_step(const AttemptAtStep<dim> &attempt) const;

    /** All conditions: those that fix, that let slip, that load. */
    const std::vector<Named> &
    list() const
    {
      return list_;
    }

    /** How stiffly points are held. */
    const NitschePenalty &
    nitsche() const
    {
      return nitsche_;
    }

  private:
    std::vector<Named> list_;
    NitschePenalty     nitsche_;
  };
} // namespace Morula

#endif
