// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_drag_h
#define morula_mechanics_drag_h

#include <morula/mechanics/point_term.h>

#include <vector>

namespace Morula
{
  /** A resistance to the displacement of cells in a step, with the energy
   *  Σ k |u|²/2: friction, doc/theory.md (4.7a), or the weak drag (4.8f). */
  template <int dim>
  class Drag : public PointTerm<dim>
  {
  public:
    /** k h²/(E V⁰) below which rounding decides where a free piece goes. */
    static constexpr double least = 1e-4;

    /** @param stiffnesses k of each cell, kPa µm^(dim-2) */
    Drag(GroupedPoints<dim> cells, std::vector<double> stiffnesses);

    /** Lets the drag act from where these displacements of the cells (µm) have
     *  brought them, instead of from u = 0. */
    void
    set_centre(std::vector<Tensor<1, dim>> ways);

    /** Multiplies all k by @p strength, instead of by 1. */
    void
    set_strength(const double strength);

    void
    add(const unsigned int     grid_cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

  private:
    /** Energy and residual. */
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override;

    const std::vector<double>   stiffnesses;
    std::vector<Tensor<1, dim>> centre; // of each cell; empty: 0
    double                      strength = 1.;
  };
} // namespace Morula

#endif
