// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_following_pressure_h
#define morula_effects_surface_following_pressure_h

#include <morula/mechanics/material_points.h>
#include <morula/mechanics/term.h>

#include <vector>

namespace Morula
{
  /**
   * A pressure that follows the surface: the force on a boundary point is
   * -p a n with the current area and normal a n = det f f⁻ᵀ a_t n_t
   * (Nanson). It has no energy, and its tangent
   * N_a p (m_i g_b^j - m_j g_b^i), m = a n, is unsymmetric: doc/theory.md
   * (4.8).
   */
  template <int dim>
  class FollowingPressure : public Term<dim>
  {
  public:
    /** What presses on a boundary point. */
    struct Load
    {
      /** p, kPa; positive pushes inward. */
      double pressure;
      /** a_t n_t, µm^(dim-1). */
      Tensor<1, dim> area;
    };

    FollowingPressure(GroupedPoints<dim> points, std::vector<Load> loads);

    void
    add(const unsigned int     cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

    bool
    is_conservative() const override;

  private:
    const GroupedPoints<dim> points;
    const std::vector<Load>  loads;
  };
} // namespace Morula

#endif
