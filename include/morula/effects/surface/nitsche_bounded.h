// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_surface_nitsche_bounded_h
#define morula_effects_surface_nitsche_bounded_h

#include <morula/effects/surface/nitsche.h>
#include <morula/mechanics/point_term.h>

#include <vector>

namespace Morula
{
  /**
   * Prescribed positions of boundary points by Nitsche's method with a traction
   * that does not change while an equilibrium is found, doc/theory.md (4.6a):
   *
   *   Π = Σ a_t [β/2 g·g (1 + (|g|/g₀)⁴/3) - T·g], g = M (x_t + u - x̄).
   *
   * It is a convex function of u with a lower bound, whatever T and the
   * deformation of the point. Who owns T takes it anew at the equilibrium that
   * was found, and has another one found from there. g₀ is a fifth of the grid
   * spacing: far smaller gaps meet the penalty β alone, larger ones ever more,
   * so that tissue does not slip through a clamp that is soft at its edge.
   */
  template <int dim>
  class BoundedNitsche : public PointTerm<dim>
  {
  public:
    using HeldPoint = typename Nitsche<dim>::HeldPoint;

    /** @param tractions M T of the points, kPa; a reference is kept */
    BoundedNitsche(GroupedPoints<dim>                 points,
                   std::vector<HeldPoint>             held_points,
                   const std::vector<Tensor<1, dim>> &tractions);

  private:
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override;

    const std::vector<HeldPoint>       held_points;
    const std::vector<Tensor<1, dim>> &tractions;
  };
} // namespace Morula

#endif
