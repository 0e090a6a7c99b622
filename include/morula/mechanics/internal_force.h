// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_internal_force_h
#define morula_mechanics_internal_force_h

#include <morula/mechanics/material_points.h>
#include <morula/mechanics/materials/response.h>
#include <morula/mechanics/term.h>
#include <morula/mechanics/vector_kernels.h>

#include <cmath>
#include <memory>
#include <string>

namespace Morula
{
  /** The volumetric strain of one grid cell, from sums over its points, and
   *  what follows from it: projected, doc/theory.md (2.6), (2.7); pooled,
   *  doc/theory.md (2.8), (2.9). */
  template <int dim>
  struct VolumeMean
  {
    static constexpr unsigned int n = BSpline<dim>::n;

    /** The form, which is any but pointwise: that needs no mean. */
    const VolumetricStrain form = VolumetricStrain::projected;
    /** Pooled: whether the grid cell is under pressure as the step begins, so
     *  that ϑ takes the mean of ln det f, doc/theory.md (2.9b); and ϑ then. */
    const bool   pressed = false;
    const double start   = 0.;

    /** Λ = Σ W k. */
    double modulus = 0.;
    /** Σ w: projected w = W k, pooled w = W J_e, the volumes, which are those
     *  at the beginning of the step if pressed. */
    double weight = 0.;
    /** Projected: Σ w ln J_e; pooled: Σ W, the grown volumes; pressed: Σ w ln
     *  det f. */
    double sum = 0.;
    /** Σ w g_a. */
    double gradients[dim][n] = {};

    /** ϑ; 0 without points. */
    double
    theta() const
    {
      if (weight == 0.)
        return 0.;
      return form == VolumetricStrain::pooled && !pressed ?
               std::log(weight / sum) :
               start + sum / weight;
    }

    /** Energy Λ U(ϑ) and its forces. */
    void
    add_forces(const Volumetric<double> &U, LocalSystem<dim> &system) const
    {
      system.add_energy(modulus * U.energy, modulus * U.magnitude);
      const double factor = U.slope * share();
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          system.add_force(i, a, factor * gradients[i][a]);
    }

    /** Λ U'' ḡ_a^i ḡ_b^j; pooled and not pressed, U'' - U' in the place of
     *  U''. */
    void
    add_tangent(const Volumetric<double> &U, LocalSystem<dim> &system) const
    {
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      if (weight == 0.)
        return;
      const double curvature  = form == VolumetricStrain::pooled && !pressed ?
                                  U.curvature - U.slope :
                                  U.curvature;
      const double scale      = curvature * share();
      const double *const all = &gradients[0][0];
      for (unsigned int row = 0; row < n_dofs; ++row)
        {
          const double factor = scale * (all[row] / weight);
          for (unsigned int column = 0; column < n_dofs; ++column)
            system.matrix[row * n_dofs + column] += factor * all[column];
        }
    }

    /** What the tangent at the points needs. @param U at @p theta */
    StrainOfGridCell
    at_points(const Volumetric<double> &U, const double theta) const
    {
      return {form, pressed, theta, U.slope * share()};
    }

    /** The derivative of ϑ, 1/µm. */
    LocalField<dim>
    derivative() const
    {
      LocalField<dim> result;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          result.coefficient[i][a] =
            weight == 0. ? 0. : gradients[i][a] / weight;
      return result;
    }

  private:
    /** Λ / Σ w: exactly 1 if projected. */
    double
    share() const
    {
      return form == VolumetricStrain::pooled && weight != 0. ?
               modulus / weight :
               1.;
    }
  };

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
      const VolumetricStrain     form = VolumetricStrain::pointwise)
      : points(points)
      , form(form)
    {}

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
                const GrowthAt         growth) const
    {
      // The mean is all that is wanted of this loop over the points.
      LocalSystem<dim> unused(LocalSystem<dim>::energy_and_residual);
      add_forces(grid_cell, field, growth, &mean, unused);
      return mean;
    }

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

  /**
   * The internal force that a scene asks for.
   * @param kernel value of Solver/Kernel: "plain", the name of one of the
   *        material's vector_kernels(), or "automatic"
   */
  template <int dim>
  std::unique_ptr<InternalForce<dim>>
  internal_force(const MaterialPoints<dim> &points,
                 const VolumetricStrain     form,
                 const std::string         &kernel);
} // namespace Morula

#endif
