// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_drag_h
#define morula_mechanics_drag_h

#include <morula/mechanics/material_points.h>
#include <morula/mechanics/spline_moments.h>
#include <morula/mechanics/term.h>

#include <vector>

namespace Morula
{
  /** A resistance to the displacement of cells in a step, with the energy
   *  Σ k |u|²/2: friction, doc/theory.md (4.7a), or the weak drag (4.8f). It is
   *  linear in u, so that sums over the cells of a grid cell say all, whatever
   *  their number. */
  template <int dim>
  class Drag : public Term<dim>
  {
  public:
    /** k h²/(E V⁰) below which rounding decides where a free piece goes. */
    static constexpr double least = 1e-4;

    /** @param stiffnesses k of each cell, kPa µm^(dim-2) */
    Drag(const GroupedPoints<dim>  &cells,
         const std::vector<double> &stiffnesses);

    void
    add(const unsigned int     grid_cell,
        const LocalField<dim> &field,
        const GrowthAt         growth,
        LocalSystem<dim>      &system) const override;

  private:
    /** Of k, by grid cell. */
    std::vector<MassMoments<dim>> moments;
  };
} // namespace Morula

#endif
