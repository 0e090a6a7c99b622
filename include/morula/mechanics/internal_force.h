// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_internal_force_h
#define morula_mechanics_internal_force_h

#include <morula/mechanics/material_points.h>
#include <morula/mechanics/term.h>

namespace Morula
{
  template <int dim>
  struct ProjectedPoints;

  /**
   * The internal virtual work Σ_p W τ : ∇δu of the neo-Hookean tissue, equation
   * (2) of the paper, its energy Σ_p W Ψ and its tangent, doc/theory.md (2.4),
   * (2.5):
   *
   *   R_a = Σ_p W τ g_a, g_a = f⁻ᵀ ∇N_a,
   *   K_ab^ij = Σ_p W [λ g_a^i g_b^j + (μ - λ ln J_e) g_a^j g_b^i
   *                    + μ (g_a · b_e g_b) δ^ij].
   *
   * Projected, ln J_e in the terms with λ is its mean ϑ over the points of the
   * grid cell, weighted with W λ: one volumetric constraint a grid cell, so
   * that nearly incompressible tissue does not lock; doc/theory.md (2.7). Its
   * tangents take ϑ in the coefficient of g_a^j g_b^i from the linearisation at
   * the last tangent, if the local system has one, as if the pressure were an
   * unknown of its own: ϑ of the displacement itself is wrong by the square of
   * the correction, which times λ would swamp μ. Both agree at the solution.
   * Without that linearisation a tangent is the exact derivative.
   */
  template <int dim>
  class InternalForce : public Term<dim>
  {
  public:
    /** Keeps a reference to the points. */
    explicit InternalForce(
      const MaterialPoints<dim> &points,
      const VolumetricStrain     form = VolumetricStrain::pointwise);

    void
    add(const unsigned int     grid_cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

    /** The mean ϑ of ln J_e over the points of active grid cell @p cell with
     *  the growth at t + dt; 0 without points. */
    double
    mean_log_volume_ratio(const unsigned int     grid_cell,
                          const LocalField<dim> &field) const;

  private:
    /** Calls visit(gradients, material, W) for the points of a grid cell;
     *  false at the first that @p system does not admit. */
    template <typename Visit>
    bool
    for_each_point(const unsigned int     grid_cell,
                   const LocalField<dim> &field,
                   const GrowthAt         growth,
                   LocalSystem<dim>      &system,
                   const Visit           &visit) const;

    // Add energy and residual or, if there is one, to the blocks (i, j), i <=
    // j, of the tangent; false if a point is inverted.
    bool
    add_pointwise(const unsigned int     grid_cell,
                  const LocalField<dim> &field,
                  const GrowthAt         growth,
                  double                *tangent,
                  LocalSystem<dim>      &system) const;
    bool
    add_projected(const unsigned int     grid_cell,
                  const LocalField<dim> &field,
                  const GrowthAt         growth,
                  double                *tangent,
                  LocalSystem<dim>      &system) const;

    /** Collects the points of a grid cell; false if one is inverted. */
    bool
    project(const unsigned int     grid_cell,
            const LocalField<dim> &field,
            const GrowthAt         growth,
            LocalSystem<dim>      &system,
            ProjectedPoints<dim>  &projected) const;

    /** ϑ with the growth at t + dt and its derivative at @p field, for the next
     *  tangent. */
    VolumeLinearisation<dim>
    linearisation(const unsigned int          grid_cell,
                  const LocalField<dim>      &field,
                  const GrowthAt              growth,
                  const ProjectedPoints<dim> &projected) const;

    const MaterialPoints<dim> &points;
    const VolumetricStrain     form;
  };
} // namespace Morula

#endif
