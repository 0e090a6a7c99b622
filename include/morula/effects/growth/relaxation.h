// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_relaxation_h
#define morula_effects_growth_relaxation_h

#include <morula/base/expression_key.h>
#include <morula/effects/growth/growth_law.h>
#include <morula/mechanics/material.h>

#include <deal.II/base/tensor.h>

#include <memory>

namespace Morula
{
  using namespace dealii;

  /** The keys of section "Material" that let tissue flow. */
  struct RelaxationParameters : public EffectKeys
  {
    RelaxationParameters();

    ExpressionKey time{
      {this, "Material/Relaxation time"},
      "0",
      "Time in which shear stress at constant strain falls to 1/e: the "
      "viscosity over the shear modulus; >= 0. 0: elastic. Volume does not "
      "relax. Epithelia have about 0.05. Units: day.",
      Evaluated::step,
      not_negative("day", "0 is elastic tissue.")};

    ExpressionKey yield_stress{
      {this, "Material/Yield stress"},
      "0",
      "The von Mises stress up to which nothing relaxes; >= 0. Units: kPa.",
      Evaluated::step,
      not_negative("kPa", "With 0 any shear stress relaxes.")};

    Key<unsigned int> passes{
      {this, "Material/Relaxation passes"},
      1,
      "Number of parts into which the relaxation of a step with a Yield "
      "stress is divided. More are more exact where the strain is given, and "
      "less exact where the load is given.",
      {1, 10000}};

    bool
    is_on() const override
    {
      // A time of zero stands for elastic tissue, though the limit would be a
      // fluid.
      return !time.expression(3).is_always(0.);
    }
  };

  /** What cells whose stiffness changes give up of their elastic strain,
   *  `Material/On transition`: doc/theory.md, section 6.8. Null if they keep
   *  all. */
  template <int dim>
  std::unique_ptr<const Flow<dim>>
  flow_of_transitions(const MaterialParameters &keys,
                      const EffectSetting<dim> &setting,
                      const bool                has_types);
} // namespace Morula

#endif
