// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/effects/part_of_step.h>
#include <morula/effects/surface/boundary_terms.h>

#include <algorithm>
#include <utility>

namespace Morula
{
  namespace
  {
    /** What is added to the least penalty for squeezed tissue, in units of the
     *  stiffness beyond that at rest by h: doc/theory.md (4.6). Less leaves the
     *  symmetric form indefinite; in the bounded one evenly squeezed tissue
     *  becomes uneven. */
    constexpr double squeezed_penalty = 100.;
  } // namespace


  void
  NitscheParameters::review(const MaterialParameters &material,
                            const bool                all_is_fixed,
                            Review                   &review) const
  {
    // The warnings concern values that do nothing, or that hold tissue too
    // softly.
    const Lame unit =
      lame(1., material.poissons_ratio.largest_number(3).value_or(0.));
    const double least = least_penalty * (unit.lambda + 2. * unit.mu);
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


  double
  NitscheParameters::beta(const double           E,
                          const Lame            &lame,
                          const double           stiffness,
                          const VolumetricStrain volumetric_form,
                          const double           h) const
  {
    // This is doc/theory.md (4.6), and section 2.4 where the pressure is the
    // pool's.
    const double at_rest = lame.lambda + 2. * lame.mu;
    if (kind() != NitscheForm::bounded &&
        volumetric_form != VolumetricStrain::pointwise)
      return penalty * at_rest / h;
    const double least =
      kind() == NitscheForm::unsymmetric ?
        0. :
        least_penalty * at_rest +
          squeezed_penalty * std::max(0., stiffness - at_rest);
    return std::max(penalty * E, least) / h;
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
    if (has_dirichlet() && nitsche_.kind() == NitscheForm::bounded)
      {
        const TimerOutput::Scope section(attempt.timer, "nitsche");
        everywhere(attempt.comm,
                   [&]() { parts.push_back(held_traction(*this, attempt)); });
      }
    for (const Named &named : list_)
      for (auto &part : named.condition->parts_of_step(attempt))
        parts.push_back(std::move(part));
    return parts;
  }


  template class BoundaryConditions<2>;
  template class BoundaryConditions<3>;
} // namespace Morula
