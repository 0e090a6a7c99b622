// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_cell_domain_h
#define morula_particles_cell_domain_h

#include <morula/grid/particle_domain.h>
#include <morula/particles/cell_state.h>

namespace Morula
{
  /**
   * The box of volume V around a cell, deformed as the cell is: doc/theory.md
   * (2.2b). Where cells proliferate, only their elastic deformation counts: a
   * cell that grows to double length and divides leaves two of the shape that
   * it had, though F stays doubled.
   */
  template <int dim>
  DeformedCube<dim>
  cell_shape(const CellView<dim, const double> &cell)
  {
    if (!cell.columns().parent.exists())
      return {cell.initial_volume(), cell.F()};
    return {cell.initial_volume() * determinant(cell.growth()),
            cell.elastic_deformation()};
  }

  /** As cell_shape(), around @p x, µm. */
  template <int dim>
  ParticleDomain<dim>
  cell_domain(const Point<dim> &x, const CellView<dim, const double> &cell)
  {
    return cell_shape<dim>(cell).at(x);
  }
} // namespace Morula

#endif
