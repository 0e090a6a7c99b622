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
   * tangents after the first then take ϑ in the coefficient of g_a^j g_b^i as
   * the linearisation at the previous tangent foresaw it, as if the pressure
   * were an unknown of its own: ϑ of the displacement itself is wrong by the
   * square of the correction, which times λ would swamp μ. Both agree at the
   * solution.
   */
  template <int dim>
  class InternalForce : public Term<dim>
  {
  public:
    /**
     * Keeps a reference to the points.
     * @param foresee false: all projected tangents are the exact derivatives
     */
    explicit InternalForce(
      const MaterialPoints<dim> &points,
      const VolumetricStrain     form    = VolumetricStrain::pointwise,
      const bool                 foresee = true);

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

    /** ϑ for the tangent at @p field; remembers this one for the next. */
    double
    foreseen(const unsigned int          grid_cell,
             const LocalField<dim>      &field,
             const GrowthAt              growth,
             const ProjectedPoints<dim> &projected) const;

    /** ϑ of a grid cell and its derivative where the last tangent was taken. */
    struct Linearisation
    {
      LocalField<dim> field;
      LocalField<dim> derivative;
      double          value;

      /** The linearised value at the coefficients @p other. */
      double
      at(const LocalField<dim> &other) const;
    };

    const MaterialPoints<dim> &points;
    const VolumetricStrain     form;
    const bool                 foresee;

    // By active grid cell; empty before the first projected tangent.
    mutable std::vector<Linearisation> linearisations;
    mutable std::vector<bool>          linearised;
  };
} // namespace Morula

#endif
