// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_internal_force_h
#define morula_mechanics_internal_force_h

#include <morula/mechanics/material_points.h>
#include <morula/mechanics/term.h>

namespace Morula
{
  /**
   * The internal virtual work Σ_p W τ : ∇δu of the neo-Hookean tissue, its
   * energy Σ_p W Ψ and its tangent (doc/theory.md, section 2):
   *
   *   R_a = Σ_p W τ g_a, g_a = f⁻ᵀ ∇N_a,
   *   K_ab^ij = Σ_p W [λ g_a^i g_b^j + (μ - λ ln J_e) g_a^j g_b^i
   *                    + μ (g_a · b_e g_b) δ^ij].
   */
  template <int dim>
  class InternalForce : public Term<dim>
  {
  public:
    /** Keeps a reference to the points. */
    explicit InternalForce(const MaterialPoints<dim> &points);

    void
    add(const unsigned int     cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

  private:
    const MaterialPoints<dim> &points;
  };
} // namespace Morula

#endif
