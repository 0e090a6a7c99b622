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
  /** The volume v of a pool at a displacement, and the forces of its energy
   *  Λ U(ϑ), ϑ = ln v/G: doc/theory.md (2.6), (2.8); under pressure (2.8b). */
  template <int dim>
  struct PoolVolume
  {
    static constexpr unsigned int n = BSpline<dim>::n;

    /** Σ c, µm^dim, if the pool is under pressure as the step begins; else 0.
     */
    double start;
    /** v = Σ c det f, µm^dim; under pressure Σ c ln det f. */
    double v = 0.;
    /** V_a = Σ c det f g_a; under pressure Σ c g_a. */
    double gradients[dim][n] = {};

    bool
    pressed() const
    {
      return start > 0.;
    }

    /** ϑ. @param grown G of the growth that counts, µm^dim */
    double
    theta(const double grown) const
    {
      return pressed() ? std::log(start / grown) + v / start :
                         std::log(v / grown);
    }

    /** The factor of the gradients in those of ϑ, 1/µm^dim. */
    double
    share() const
    {
      return 1. / (pressed() ? start : v);
    }

    /** q, kPa. */
    PressureOfPool
    pressure(const Volumetric<double> &U) const
    {
      return {U.modulus * U.slope * share(), pressed()};
    }

    /** The energy and q V_a. */
    void
    add_forces(const Volumetric<double> &U, LocalSystem<dim> &system) const
    {
      system.add_energy(U.modulus * U.energy, U.modulus * U.magnitude);
      const double q = pressure(U).mean_stress;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          system.add_force(i, a, q * gradients[i][a]);
    }

    /** Φ'' V_a V_b. */
    void
    add_tangent(const Volumetric<double> &U, LocalSystem<dim> &system) const
    {
      constexpr unsigned int n_dofs = LocalSystem<dim>::n_dofs;
      const double           scale  = U.modulus *
                           (U.curvature - (pressed() ? 0. : U.slope)) *
                           share() * share();
      const double *const all = &gradients[0][0];
      for (unsigned int row = 0; row < n_dofs; ++row)
        {
          const double factor = scale * all[row];
          for (unsigned int column = 0; column < n_dofs; ++column)
            system.matrix[row * n_dofs + column] += factor * all[column];
        }
    }

    /** The derivative of ϑ, 1/µm. */
    LocalField<dim>
    derivative() const
    {
      LocalField<dim> result;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int a = 0; a < n; ++a)
          result.coefficient[i][a] = gradients[i][a] * share();
      return result;
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
   * with the coefficients of the material's law (Response). Pooled, the
   * volumetric part is that of the sum of the volumes that the points of a pool
   * carry, (2.6) to (2.8b): one volumetric constraint a pool, so that nearly
   * incompressible tissue does not lock. Such tangents take ϑ from the
   * linearisation at the last tangent, if the local system has one, as if the
   * pressure were an unknown of its own: ϑ of the displacement itself is wrong
   * by the square of the correction, which times λ would swamp μ. Both agree at
   * the solution. Without that linearisation a tangent is the exact derivative.
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

    /** The energy of pool number @p pool, and its J_e, with the growth at
     *  t + dt. Pooled only. @param field of its grid cell */
    PoolEnergy
    energy_of(const unsigned int pool, const LocalField<dim> &field) const
    {
      const Pool &of = points.pools.list[pool];
      return pool_energy(points.pools,
                         of,
                         GrowthAt::current,
                         std::log(
                           with_points({0.}, of, field, GrowthAt::current).v /
                           grown(of, GrowthAt::current)),
                         *points.material);
    }

  protected:
    /** Points of a grid cell: [first, last). */
    struct Range
    {
      unsigned int first, last;
    };

    const MaterialPoints<dim> &points;
    const VolumetricStrain     form;

  private:
    /** Adds energy and residual or, if there is a @p volume, those of the
     *  distortional part, and to the volume. False if a point is inverted. */
    virtual bool
    add_forces(const Range           &range,
               const LocalField<dim> &field,
               const GrowthAt         growth,
               PoolVolume<dim>       *volume,
               LocalSystem<dim>      &system) const;

    /** Adds to the tangent; of a pool with this pressure, all but the
     *  product V_a V_b in (2.8). False if a point is inverted. */
    virtual bool
    add_tangent(const Range           &range,
                const LocalField<dim> &field,
                const GrowthAt         growth,
                const PressureOfPool  *pressure,
                LocalSystem<dim>      &system) const;

    /** Calls visit(gradients, state, W, volume) for these points with the
     * volume c det f that they carry; false at the first that @p system does
     * not admit. */
    template <typename Visit>
    bool
    for_each_point(const Range           &range,
                   const LocalField<dim> &field,
                   const GrowthAt         growth,
                   LocalSystem<dim>      &system,
                   const Visit           &visit) const;

    /** The volume before points are added. */
    PoolVolume<dim>
    volume_without_points(const Pool &pool, const GrowthAt growth) const
    {
      double carried = 0.;
      for (unsigned int p = pool.first; p < pool.last; ++p)
        carried += points.carried[p];
      return {carried < grown(pool, growth) ? carried : 0.};
    }

    /** @p volume, and the points of a pool. */
    PoolVolume<dim>
    with_points(PoolVolume<dim>        volume,
                const Pool            &pool,
                const LocalField<dim> &field,
                const GrowthAt         growth) const
    {
      // The volume is all that is wanted of this loop over the points.
      LocalSystem<dim> unused(LocalSystem<dim>::energy_and_residual);
      add_forces({pool.first, pool.last}, field, growth, &volume, unused);
      return volume;
    }

    double
    grown(const Pool &pool, const GrowthAt growth) const
    {
      double sum = 0.;
      for (unsigned int g = pool.first_group; g < pool.last_group; ++g)
        sum += points.pools.groups[g].grown.at(growth);
      return sum;
    }

    void
    add_tangent_of_pool(const Pool            &pool,
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
