// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_cavity_column_h
#define morula_particles_cavity_column_h

#include <morula/particles/boundary_state.h>

namespace Morula
{
  /** The column that says which cavity a boundary point faces, if the scene has
   *  declared it by the name "cavity". */
  template <int dim>
  Column<unsigned int>
  cavity_column(const BoundaryColumns<dim> &columns)
  {
    return columns.template find<unsigned int>("cavity");
  }

  /** A value of cavity_column(), the same for no two bodies' cavities; 0: it is
   *  not known, 1: the outside. @param faced as in CellSurface */
  constexpr unsigned int
  faced_cavity(const unsigned int body, const unsigned int faced)
  {
    return faced == 0 ? 1 : 1 + faced + (body << 16);
  }
} // namespace Morula

#endif
