// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_growth_contraction_h
#define morula_effects_growth_contraction_h

#include <morula/base/expression_key.h>
#include <morula/effects/state/direction.h>

#include <deal.II/base/tensor.h>

namespace Morula
{
  using namespace dealii;

  /** Section "Contraction". */
  struct ContractionParameters : public EffectKeys
  {
    ExpressionKey stretch{
      {this, "Contraction/Stretch"},
      "1",
      "Stress-free length of a cell along Direction, relative to that "
      "without contraction, gamma; > 0. Below 1 cells contract, above 1 they "
      "lengthen. A value that differs from 1 from the start on acts in the "
      "first step: ramp it, as 1 - 0.3*min(t, 1).",
      Evaluated::step,
      positive("(a ratio of lengths)", "1 is no contraction.")};

    Key<bool> keep_volume{
      {this, "Contraction/Keep volume"},
      true,
      "Whether cells widen across Direction as they contract, so "
      "that they keep their volume."};

    CellDirectionKey direction{
      {this, "Contraction/Direction"},
      "surface normal",
      "Along what cells contract, in the body as it was at t = 0: a "
      "vector, an expression with the components separated by ';', "
      "or radial (from Tissue/Center), or surface normal (of the "
      "surface near the founder), or gradient of NAME (a field)."};

    EffectFacts
    facts() const override
    {
      return {&stretch};
    }
  };

  /**
   * F_a = γ a⊗a + γ' (I - a⊗a), doc/theory.md (9.1): the deformation of a cell
   * that nothing holds, which contracts along the unit vector @p a.
   * @param gamma γ > 0
   * @param keep_volume whether det F_a = 1; otherwise γ' = 1
   */
  template <int dim>
  Tensor<2, dim>
  active_strain(const Tensor<1, dim> &a,
                const double          gamma,
                const bool            keep_volume);
} // namespace Morula

#endif
