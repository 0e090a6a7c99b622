// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_cell_domain_h
#define morula_particles_cell_domain_h

#include <morula/grid/particle_domain.h>
#include <morula/particles/cell_state.h>

namespace Morula
{
  /**
   * The box of volume V around a cell at @p x (µm), deformed as the cell is:
   * doc/theory.md (2.2b). Where cells proliferate, only their elastic
   * deformation counts: a cell that grows to double length and divides leaves
   * two of the shape that it had, though F stays doubled.
   */
  template <int dim, typename Number>
  ParticleDomain<dim>
  cell_domain(const Point<dim> &x, const CellView<dim, Number> &cell)
  {
    if (cell.layout().division_axis == CellSlots<dim>::absent)
      return ParticleDomain<dim>(x,
                                 std::pow(cell.initial_volume(), 1. / dim) *
                                   cell.deformation());
    const double grown = cell.initial_volume() * determinant(cell.growth());
    return ParticleDomain<dim>(x,
                               std::pow(grown, 1. / dim) *
                                 elastic_deformation(cell));
  }
} // namespace Morula

#endif
