// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_dead_load_h
#define morula_effects_surface_dead_load_h

#include <morula/mechanics/point_term.h>

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
    DeadLoad(GroupedPoints<dim> points, std::vector<Tensor<1, dim>> forces);

    void
    add(const unsigned int     cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

  private:
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override;

    const std::vector<Tensor<1, dim>> forces;
  };
} // namespace Morula

#endif
