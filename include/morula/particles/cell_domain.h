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
  template <int dim>
  ParticleDomain<dim>
  cell_domain(const Point<dim> &x, const CellView<dim, const double> &cell)
  {
    if (!cell.columns().parent.exists())
      return ParticleDomain<dim>(x,
                                 std::pow(cell.initial_volume(), 1. / dim) *
                                   cell.F());
    const double grown = cell.initial_volume() * determinant(cell.growth());
    return ParticleDomain<dim>(x,
                               std::pow(grown, 1. / dim) *
                                 cell.elastic_deformation());
  }
} // namespace Morula

#endif
