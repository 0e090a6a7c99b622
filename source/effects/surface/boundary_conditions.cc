// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/part_of_step.h>
#include <morula/effects/surface/boundary_condition.h>
#include <morula/effects/surface/boundary_conditions.h>
#include <morula/effects/surface/boundary_terms.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  namespace
  {
    /** Least penalty of the forms with an energy, in units of (λ + 2μ)/h, and
     *  what is added for squeezed tissue, in units of the stiffness beyond that
     *  at rest by h: doc/theory.md (4.6). Less leaves the symmetric form
     *  indefinite; in the bounded one evenly squeezed tissue becomes uneven. */
    constexpr double least_penalty    = NitscheParameters::least_penalty;
    constexpr double squeezed_penalty = 100.;

    NitscheForm
    form_called(const std::string &name)
    {
      return name == "symmetric"   ? NitscheForm::symmetric :
             name == "unsymmetric" ? NitscheForm::unsymmetric :
                                     NitscheForm::bounded;
    }
  } // namespace


  std::vector<std::string>
  NitscheParameters::held_by()
  {
    return {"Boundary conditions/Fixed where",
            "Boundary conditions/Slip where"};
  }


  NitscheParameters::NitscheParameters()
  {
    penalty.with("paper", "1000");
    form.with("paper", "symmetric");
    for (AnyKey *const key : list())
      key->needs(held_by());
  }


  void
  NitscheParameters::review(const MaterialParameters &material,
                            const bool                all_is_fixed,
                            Review                   &review) const
  {
    // The warnings concern values that do nothing, or that hold tissue too
    // softly.
    const double least = NitschePenalty::least(
      material.poissons_ratio.largest_number(3).value_or(0.));
    if (material.volumetric_form() == VolumetricStrain::pointwise &&
        form == "symmetric" && review.has_set(penalty) && penalty < least)
      review.warn(penalty.path(),
                  as_text(penalty) + " E/h",
                  "the symmetric form never uses less than " +
                    as_text(least_penalty) + " (lambda + 2 mu)/h, here " +
                    as_text(least) +
                    " E/h, so that this value has no effect "
                    "(doc/theory.md, section 4.2).",
                  "Raise it, or set " + form.path() + " = unsymmetric.");
    // A small penalty gives way under pressure, as where tissue grows between
    // its clamps.
    if (all_is_fixed && form == "unsymmetric" && penalty < 100.)
      review.warn(
        penalty.path(),
        as_text(penalty) + " E/h",
        "all of the surface is fixed, and gives way where tissue is pressed "
        "against it: in a ball that grows to 1.1 in all directions the "
        "energy is 9 % low at a penalty of 20 (doc/accuracy-and-cost.md, "
        "which method).",
        "Set " + form.path() + " = bounded, or raise the penalty to 1000.");
  }


  NitschePenalty::NitschePenalty(const NitscheParameters &parameters)
    : relative(parameters.penalty)
    , form_(form_called(parameters.form))
  {}


  double
  NitschePenalty::penalty(const double           E,
                          const Lame            &lame,
                          const double           stiffness,
                          const VolumetricStrain volumetric_form,
                          const double           h) const
  {
    // This is doc/theory.md (4.6), and section 2.4 where the pressure is the
    // grid cell's.
    const double at_rest = lame.lambda + 2. * lame.mu;
    if (form_ != NitscheForm::bounded &&
        volumetric_form != VolumetricStrain::pointwise)
      return relative * at_rest / h;
    const double least =
      form_ == NitscheForm::unsymmetric ?
        0. :
        least_penalty * at_rest +
          squeezed_penalty * std::max(0., stiffness - at_rest);
    return std::max(relative * E, least) / h;
  }


  double
  NitschePenalty::least(const double nu)
  {
    const Lame unit = lame(1., nu);
    return least_penalty * (unit.lambda + 2. * unit.mu);
  }


  template <int dim>
  Tensor<1, dim>
  BoundaryCondition<dim>::displacement(const Point<dim> &, const double) const
  {
    return Tensor<1, dim>();
  }


  template <int dim>
  std::vector<typename BoundaryCondition<dim>::Part>
  BoundaryCondition<dim>::parts(const LoadedPoints<dim> &points,
                                const double             t) const
  {
    std::vector<Part> list;
    if (auto whole = term(points, t))
      list.push_back({"", std::move(whole)});
    return list;
  }


  // Here, as a null pointer to an unknown class could not be deleted.
  template <int dim>
  std::unique_ptr<PartOfStep<dim>>
  BoundaryCondition<dim>::part_of_step(const AttemptAtStep<dim> &) const
  {
    return nullptr;
  }


  template <int dim>
  bool
  BoundaryCondition<dim>::moves() const
  {
    // A load moves tissue from rest; what holds points does so only if it is
    // prescribed to move.
    return kind() == SurfaceCondition::loaded;
  }


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
        everywhere(attempt.comm,
                   [&]() { parts.push_back(held_traction(*this, attempt)); });
      }
    for (const Named &named : list_)
      if (auto part = named.condition->part_of_step(attempt))
        parts.push_back(std::move(part));
    return parts;
  }


  template class BoundaryCondition<2>;
  template class BoundaryCondition<3>;
  template class BoundaryConditions<2>;
  template class BoundaryConditions<3>;
} // namespace Morula
