// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_nitsche_penalty_h
#define morula_effects_surface_nitsche_penalty_h

#include <morula/base/key.h>
#include <morula/base/review.h>
#include <morula/effects/surface/nitsche.h>
#include <morula/mechanics/material.h>

namespace Morula
{
  /** The keys of Nitsche's term, in section "Boundary conditions". */
  struct NitscheParameters : public Keys
  {
    NitscheParameters();

    /** Least penalty of the forms with an energy, (λ + 2μ)/h. */
    static constexpr double least_penalty = 20.;

    Key<double> penalty{
      {this, "Boundary conditions/Nitsche penalty"},
      20.,
      "Penalty of fixed and slip points; > 0. "
      "The symmetric and the bounded form use at least " +
        as_text(least_penalty) + " (lambda + 2 mu)/h. Units: E/h.",
      {},
      positive("E/h",
               "1e3 is a good choice for the symmetric Nitsche form, 20 "
               "for the others.")};

    Key<std::string> form{
      {this, "Boundary conditions/Nitsche form"},
      "bounded",
      "symmetric: the paper's, for large penalties. unsymmetric: stable for "
      "any penalty, but without an energy. bounded: the traction of held "
      "points comes from the cells around them, is constant in a solve and "
      "renewed after it; its energy has a lower bound, and with Nitsche "
      "penalty = 20 it is much more accurate beside the edge of a fixed "
      "surface.",
      {"symmetric|unsymmetric|bounded"}};

    /** Full paths of the keys that hold points. */
    static std::vector<std::string>
    held_by();

    /** Warns of penalties that have no effect, or that are too low if
     *  @p all_is_fixed (all of the surface). For scenes that hold points. */
    void
    review(const MaterialParameters &material,
           const bool                all_is_fixed,
           Review                   &review) const;
  };

  /** How stiffly fixed and slip points are held. */
  class NitschePenalty
  {
  public:
    /** Takes the values of the keys. */
    explicit NitschePenalty(const NitscheParameters &parameters);

    /** Nitsche's penalty β, kPa/µm, for a point with Young's modulus @p E,
     *  Lamé constants @p lame and the @p stiffness that it has now (kPa) on a
     *  grid of spacing @p h (µm): doc/theory.md (4.6). */
    double
    penalty(const double           E,
            const Lame            &lame,
            const double           stiffness,
            const VolumetricStrain volumetric_form,
            const double           h) const;

    /** The least penalty of the symmetric form for tissue at rest, in units of
     *  E/h, with Poisson's ratio @p nu. */
    static double
    least(const double nu);

    /** Which of Nitsche's terms. */
    NitscheForm
    form() const
    {
      return form_;
    }

  private:
    double      relative; // β h / E
    NitscheForm form_;
  };
} // namespace Morula

#endif
