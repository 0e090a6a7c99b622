// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_volume_mean_h
#define morula_mechanics_volume_mean_h

#include <morula/mechanics/materials/response.h>
#include <morula/mechanics/term.h>
#include <morula/mechanics/volumetric_strain.h>

#include <cmath>

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
} // namespace Morula

#endif
