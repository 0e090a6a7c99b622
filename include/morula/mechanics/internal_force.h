// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_internal_force_h
#define morula_mechanics_internal_force_h

#include <morula/mechanics/material_points.h>
#include <morula/mechanics/term.h>
#include <morula/mechanics/volume_mean.h>

namespace Morula
{
  /**
   * The internal virtual work Σ_p W τ : ∇δu of the tissue, equation (2) of the
   * paper, its energy Σ_p W Ψ and its tangent, doc/theory.md (2.4), (2.5):
   *
   *   R_a = Σ_p W τ g_a, g_a = f⁻ᵀ ∇N_a,
   *   K_ab^ij = Σ_p W [A g_a^i g_b^j + (α - γ) g_a^j g_b^i
   *                    + α (g_a · b_e g_b) δ^ij
   *                    + B ((b_e g_a)^i g_b^j + g_a^i (b_e g_b)^j)
   *                    + C (b_e g_a)^i (b_e g_b)^j]
   *
   * with the coefficients of the material's law (Response). Projected, ln J_e
   * in the volumetric part is its mean ϑ over the points of the grid cell: one
   * volumetric constraint a grid cell, so that nearly incompressible tissue
   * does not lock; doc/theory.md (2.7). Pooled, it is that of the sum of the
   * points' volumes, (2.9), where W must be the grown volume; under pressure
   * its change in the step is the mean of ln det f, (2.9b). Such tangents take
   * ϑ from the linearisation at the last tangent, if the local system has one,
   * as if the pressure were an unknown of its own: ϑ of the displacement itself
   * is wrong by the square of the correction, which times λ would swamp μ. Both
   * agree at the solution. Without that linearisation a tangent is the exact
   * derivative.
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

    /** ϑ of active grid cell @p grid_cell with the growth at t + dt; 0 without
     *  points. Not pointwise. */
    double
    log_volume_ratio(const unsigned int     grid_cell,
                     const LocalField<dim> &field) const
    {
      return mean_of(grid_cell, field, GrowthAt::current).theta();
    }

    /** The same, but pooled always that of the sum of the volumes, (2.8): what
     *  its points have after the step. */
    double
    log_volume_ratio_after(const unsigned int     grid_cell,
                           const LocalField<dim> &field) const
    {
      return with_points({form}, grid_cell, field, GrowthAt::current).theta();
    }

  protected:
    const MaterialPoints<dim> &points;
    const VolumetricStrain     form;

  private:
    /** Adds energy and residual or, if there is a @p mean, those of the
     *  distortional part, and to the mean. False if a point is inverted. */
    virtual bool
    add_forces(const unsigned int     grid_cell,
               const LocalField<dim> &field,
               const GrowthAt         growth,
               VolumeMean<dim>       *mean,
               LocalSystem<dim>      &system) const;

    /** Adds to the tangent; if there is a @p strain, all but the product of the
     *  means in (2.7). False if a point is inverted. */
    virtual bool
    add_tangent(const unsigned int      grid_cell,
                const LocalField<dim>  &field,
                const GrowthAt          growth,
                const StrainOfGridCell *strain,
                LocalSystem<dim>       &system) const;

    /** Calls visit(gradients, state, W) for the points of a grid cell; false at
     *  the first that @p system does not admit. */
    template <typename Visit>
    bool
    for_each_point(const unsigned int     grid_cell,
                   const LocalField<dim> &field,
                   const GrowthAt         growth,
                   const double          *theta,
                   LocalSystem<dim>      &system,
                   const Visit           &visit) const;

    /** The mean of a grid cell before its points are added: pooled, with ϑ at
     *  the beginning of the step, by which it is pressed or not. */
    VolumeMean<dim>
    mean_without_points(const unsigned int grid_cell,
                        const GrowthAt     growth) const;

    /** @p mean, and the points of a grid cell. */
    VolumeMean<dim>
    with_points(VolumeMean<dim>        mean,
                const unsigned int     grid_cell,
                const LocalField<dim> &field,
                const GrowthAt         growth) const;

    /** The mean over the points of a grid cell. */
    VolumeMean<dim>
    mean_of(const unsigned int     grid_cell,
            const LocalField<dim> &field,
            const GrowthAt         growth) const
    {
      return with_points(mean_without_points(grid_cell, growth),
                         grid_cell,
                         field,
                         growth);
    }

    void
    add_tangent_of_grid_cell(const unsigned int     grid_cell,
                             const LocalField<dim> &field,
                             const GrowthAt         growth,
                             LocalSystem<dim>      &system) const;
  };
} // namespace Morula

#endif
