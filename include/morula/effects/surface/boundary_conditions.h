// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_boundary_conditions_h
#define morula_effects_surface_boundary_conditions_h

#include <morula/effects/surface/boundary_condition.h>
#include <morula/effects/surface/nitsche.h>
#include <morula/particles/boundary_state.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
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
                       const NitscheParameters &parameters)
      : list_(std::move(list))
      , nitsche_(parameters)
    {
      // The kinds are numbered in the order in which they win, so sorting by
      // kind puts the winner first. Conditions of one kind stay in the order in
      // which they were added.
      static_assert(SurfaceCondition::fixed < SurfaceCondition::slip &&
                    SurfaceCondition::slip < SurfaceCondition::loaded);
      std::stable_sort(list_.begin(),
                       list_.end(),
                       [](const Named &a, const Named &b) {
                         return a.condition->kind() < b.condition->kind();
                       });
    }

    /** What the winning condition does to the point with initial position
     *  @p X (µm) and initial normal @p N; asked at t = 0. */
    SurfaceCondition
    condition(const Point<dim> &X, const Tensor<1, dim> &N) const
    {
      const unsigned int k = winner(X, N);
      return k < list_.size() ? list_[k].condition->kind() :
                                SurfaceCondition::free;
    }

    /**
     * The number in list() of the condition that wins at such a point, list()
     * .size() if none acts. Of several that load, the first is named.
     */
    unsigned int
    winner(const Point<dim> &X, const Tensor<1, dim> &N) const
    {
      unsigned int k = 0;
      while (k < list_.size() && !list_[k].condition->acts_on(X, N))
        ++k;
      return k;
    }

    /** Prescribed displacement of a fixed point, µm. The initial position of
     *  the point at t = 0 of which it is a part decides which condition fixes
     *  it. */
    Tensor<1, dim>
    displacement(const BoundaryView<dim> &point, const double t) const
    {
      // With one condition that fixes it is clear which one moves the point.
      const bool only_one = list_.size() < 2 || list_[1].condition->kind() !=
                                                  SurfaceCondition::fixed;
      const unsigned int k =
        only_one ? 0 : winner(point.seed_position(), point.initial_normal());
      AssertIndexRange(k, list_.size());
      return list_[k].condition->displacement(point.initial_position(), t);
    }

    /** Whether the same conditions act on two points. That is decided at the
     *  points at t = 0 of which they are parts. */
    bool
    alike(const BoundaryView<dim> &a, const BoundaryView<dim> &b) const
    {
      // Points may merge if each condition acts on both or on neither:
      // doc/theory.md, section 4.5.
      return a.touched() == b.touched() &&
             std::all_of(list_.begin(), list_.end(), [&](const Named &named) {
               const auto acts_on = [&named](const BoundaryView<dim> &point) {
                 return named.condition->acts_on(point.seed_position(),
                                                 point.initial_normal());
               };
               return acts_on(a) == acts_on(b);
             });
    }

    /** Whether the scene has conditions that fix or let slip. */
    bool
    has_dirichlet() const
    {
      return has(SurfaceCondition::fixed) || has(SurfaceCondition::slip);
    }

    /** Whether one of this kind exists. */
    bool
    has(const SurfaceCondition kind) const
    {
      return std::any_of(list_.begin(),
                         list_.end(),
                         [kind](const Named &named) {
                           return named.condition->kind() == kind;
                         });
    }

    /** Whether a condition only pushes. */
    bool
    has_pushing() const
    {
      return std::any_of(list_.begin(), list_.end(), [](const Named &named) {
        return named.condition->only_pushes();
      });
    }

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
    const NitscheParameters &
    nitsche() const
    {
      return nitsche_;
    }

  private:
    std::vector<Named> list_;
    NitscheParameters  nitsche_;
  };
} // namespace Morula

#endif
