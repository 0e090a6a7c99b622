// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_surface_energy_h
#define morula_effects_surface_surface_energy_h

#include <morula/effects/surface/area_term.h>

#include <vector>

namespace Morula
{
  /**
   * The energy Π = Σ γ a of a surface that pulls itself together, with the
   * current area a = |det f f⁻ᵀ a_t n_t| of each boundary point (Nanson), in
   * 2-D its length. With s_a = (I - n⊗n) g_a the residual is γ a s_a and the
   * tangent γ a (s_a^i s_b^j - s_b^i s_a^j + n_i n_j s_a·s_b), which is
   * symmetric: doc/theory.md (4.8a), (4.8b). With a smoothing ε the area is
   * √(a² + ε²) instead, which pulls nothing where a is much less than ε.
   */
  template <int dim>
  class SurfaceEnergy : public AreaTerm<dim>
  {
  public:
    /** @param smoothing ε, in the unit of the loads' areas; 0: none */
    SurfaceEnergy(GroupedPoints<dim>                        points,
                  std::vector<typename AreaTerm<dim>::Load> loads,
                  const double                              smoothing = 0.);

  private:
    void
    add_load(const typename AreaTerm<dim>::Load     &load,
             const typename AreaTerm<dim>::Deformed &point,
             LocalSystem<dim>                       &system) const override;

    const double smoothing;
  };
} // namespace Morula

#endif
