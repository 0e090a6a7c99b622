// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_drag_h
#define morula_mechanics_drag_h

#include <morula/mechanics/point_term.h>

#include <vector>

namespace Morula
{
  /**
   * A resistance to the displacement of cells in a step, with the energy
   * Σ η V⁰ |u|²/2. It is too weak to matter, except that it decides where a
   * piece of tissue goes that loads only push and nothing holds: doc/theory.md
   * (4.8f).
   */
  template <int dim>
  class Drag : public PointTerm<dim>
  {
  public:
    /** η h²/E where E is that of the stiffest cell. */
    static constexpr double relative = 1e-4;

    /**
     * @param volumes V⁰ of each cell, µm^dim
     * @param eta     η, kPa/µm²
     */
    Drag(GroupedPoints<dim>  cells,
         std::vector<double> volumes,
         const double        eta);

  private:
    void
    add_point(const unsigned int       p,
              const SplineValues<dim> &splines,
              const LocalField<dim>   &field,
              LocalSystem<dim>        &system) const override;

    const std::vector<double> volumes;
    const double              eta;
  };
} // namespace Morula

#endif
