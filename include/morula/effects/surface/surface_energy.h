// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_surface_energy_h
#define morula_effects_surface_surface_energy_h

#include <morula/mechanics/material_points.h>
#include <morula/mechanics/term.h>

#include <vector>

namespace Morula
{
  /**
   * The energy Π = Σ γ a of a surface that pulls itself together, with the
   * current area a = |det f f⁻ᵀ a_t n_t| of each boundary point (Nanson), in
   * 2-D its length. With s_a = (I - n⊗n) g_a the residual is γ a s_a and the
   * tangent γ a (s_a^i s_b^j - s_b^i s_a^j + n_i n_j s_a·s_b), which is
   * symmetric: doc/theory.md (4.8a), (4.8b).
   */
  template <int dim>
  class SurfaceEnergy : public Term<dim>
  {
  public:
    /** The tension of a boundary point. */
    struct Load
    {
      /** γ, kPa µm. */
      double tension;
      /** a_t n_t, µm^(dim-1). */
      Tensor<1, dim> area;
    };

    SurfaceEnergy(GroupedPoints<dim> points, std::vector<Load> loads);

    void
    add(const unsigned int     cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

  private:
    const GroupedPoints<dim> points;
    const std::vector<Load>  loads;
  };
} // namespace Morula

#endif
