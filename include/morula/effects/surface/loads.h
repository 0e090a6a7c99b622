// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_loads_h
#define morula_effects_surface_loads_h

#include <morula/mechanics/point_term.h>

#include <memory>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * Forces of fixed direction and size on points, energy -Σ F · u: a body force
   * on particles (F = V⁰ b per initial volume, equation (4) of the paper), or a
   * dead traction on boundary points (F = a⁰ t per initial area, equation (3)):
   * doc/theory.md (4.7).
   */
  template <int dim>
  class DeadLoad : public PointTerm<dim>
  {
  public:
    /**
     * @param forces of each point, kPa µm^(dim-1)
     */
    DeadLoad(GroupedPoints<dim> points, std::vector<Tensor<1, dim>> forces)
      : PointTerm<dim>(std::move(points))
      , forces(std::move(forces))
    {}

    void
    add(const unsigned int     grid_cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override
    {
      // A force that does not depend on u has no tangent.
      if (system.wanted != LocalSystem<dim>::tangent)
        PointTerm<dim>::add(grid_cell, field, growth, system);
    }

  private:
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override
    {
      // This is the force of doc/theory.md (4.7).
      system.add_energy(-(forces[p] * field.value(splines)));
      add_force_at(splines, -forces[p], system);
    }

    const std::vector<Tensor<1, dim>> forces;
  };

  /** What acts on a boundary point. */
  template <int dim>
  struct AreaLoad
  {
    /** What acts per area: a pressure in kPa, or a tension in kPa µm. */
    double value;
    /** a_t n_t, µm^(dim-1). */
    Tensor<1, dim> area;
  };

  /**
   * A pressure that follows the surface: the force on a boundary point is
   * -p a n with the current area and normal a n = det f f⁻ᵀ a_t n_t
   * (Nanson). It has no energy, and its tangent
   * N_a p (m_i g_b^j - m_j g_b^i), m = a n, is unsymmetric: doc/theory.md
   * (4.8).
   * p > 0 pushes inward.
   */
  template <int dim>
  std::unique_ptr<Term<dim>>
  following_pressure(GroupedPoints<dim>         points,
                     std::vector<AreaLoad<dim>> loads);

  /**
   * The energy Π = Σ γ a of a surface that pulls itself together, with the
   * current area a = |det f f⁻ᵀ a_t n_t| of each boundary point (Nanson), in
   * 2-D its length. With s_a = (I - n⊗n) g_a the residual is γ a s_a and the
   * tangent γ a (s_a^i s_b^j - s_b^i s_a^j + n_i n_j s_a·s_b), which is
   * symmetric: doc/theory.md (4.8a), (4.8b). With a smoothing ε the area is
   * √(a² + ε²) instead, which pulls nothing where a is much less than ε.
   * @param smoothing ε, in the unit of the loads' areas; 0: none
   */
  template <int dim>
  std::unique_ptr<Term<dim>>
  surface_energy(GroupedPoints<dim>         points,
                 std::vector<AreaLoad<dim>> loads,
                 const double               smoothing = 0.);
} // namespace Morula

#endif
