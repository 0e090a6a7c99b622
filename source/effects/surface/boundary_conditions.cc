// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/part_of_step.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/effects/surface/held_traction.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  template <int dim>
  BoundaryConditions<dim>::BoundaryConditions(
    std::vector<Named> list, const NitscheParameters &parameters)
    : list_(std::move(list))
    , nitsche_(parameters)
  {
    // The kinds are numbered in the order in which they win, so sorting by kind
    // puts the winner first. Conditions of one kind stay in the order in which
    // they were added.
    static_assert(SurfaceCondition::fixed < SurfaceCondition::slip &&
                  SurfaceCondition::slip < SurfaceCondition::loaded);
    std::stable_sort(list_.begin(),
                     list_.end(),
                     [](const Named &a, const Named &b) {
                       return a.condition->kind() < b.condition->kind();
                     });
  }


  template <int dim>
  SurfaceCondition
  BoundaryConditions<dim>::condition(const Point<dim>     &X,
                                     const Tensor<1, dim> &N) const
  {
    const unsigned int k = winner(X, N);
    return k < list_.size() ? list_[k].condition->kind() :
                              SurfaceCondition::free;
  }


  template <int dim>
  unsigned int
  BoundaryConditions<dim>::winner(const Point<dim>     &X,
                                  const Tensor<1, dim> &N) const
  {
    unsigned int k = 0;
    while (k < list_.size() && !list_[k].condition->acts_on(X, N))
      ++k;
    return k;
  }


  template <int dim>
  Tensor<1, dim>
  BoundaryConditions<dim>::displacement(const Point<dim>     &X_seed,
                                        const Tensor<1, dim> &N,
                                        const Point<dim>     &X,
                                        const double          t) const
  {
    // With one condition that fixes it is clear which one moves the point.
    const bool only_one =
      list_.size() < 2 || list_[1].condition->kind() != SurfaceCondition::fixed;
    const unsigned int k = only_one ? 0 : winner(X_seed, N);
    AssertIndexRange(k, list_.size());
    return list_[k].condition->displacement(X, t);
  }


  template <int dim>
  bool
  BoundaryConditions<dim>::alike(const BoundaryView<dim> &a,
                                 const BoundaryView<dim> &b) const
  {
    // Points may merge if each condition acts on both or on neither:
    // doc/theory.md, section 4.5.
    return std::all_of(list_.begin(), list_.end(), [&](const Named &named) {
      const auto acts_on = [&named](const BoundaryView<dim> &point) {
        return named.condition->acts_on(point.seed_position(),
                                        point.initial_normal());
      };
      return acts_on(a) == acts_on(b);
    });
  }


  template <int dim>
  bool
  BoundaryConditions<dim>::has(const SurfaceCondition kind) const
  {
    return std::any_of(list_.begin(), list_.end(), [kind](const Named &named) {
      return named.condition->kind() == kind;
    });
  }


  template <int dim>
  bool
  BoundaryConditions<dim>::has_pushing() const
  {
    return std::any_of(list_.begin(), list_.end(), [](const Named &named) {
      return named.condition->only_pushes();
    });
  }


  template <int dim>
  std::vector<std::unique_ptr<PartOfStep<dim>>>
  BoundaryConditions<dim>::parts_of_step(
    const AttemptAtStep<dim> &attempt) const
  {
    // The bounded form holds a traction fixed for all points that are held
    // together. Its term stands behind the forces on cells, so that it is the
    // first part.
    std::vector<std::unique_ptr<PartOfStep<dim>>> parts;
    if (has_dirichlet() && nitsche_.form() == NitscheForm::bounded)
      {
        const TimerOutput::Scope section(attempt.timer, "nitsche");
        everywhere(attempt.comm, [&]() {
          parts.push_back(std::make_unique<HeldTraction<dim>>(*this, attempt));
        });
      }
    for (const Named &named : list_)
      if (auto part = named.condition->part_of_step(attempt))
        parts.push_back(std::move(part));
    return parts;
  }


  template class BoundaryConditions<2>;
  template class BoundaryConditions<3>;
} // namespace Morula
