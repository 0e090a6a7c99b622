// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_following_pressure_h
#define morula_effects_surface_following_pressure_h

#include <morula/effects/surface/area_term.h>

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
  class FollowingPressure : public AreaTerm<dim>
  {
  public:
    using AreaTerm<dim>::AreaTerm;

    bool
    is_conservative() const override
    {
      return false;
    }

  private:
    /** p > 0 pushes inward. */
    void
    add_load(const typename AreaTerm<dim>::Load     &load,
             const typename AreaTerm<dim>::Deformed &point,
             LocalSystem<dim>                       &system) const override;
  };
} // namespace Morula

#endif
