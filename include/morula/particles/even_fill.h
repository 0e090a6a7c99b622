// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_even_fill_h
#define morula_particles_even_fill_h

#include <morula/grid/occupancy.h>
#include <morula/particles/tissue.h>

namespace Morula
{
  /**
   * Brings the volumes of cells in line with the space that they take: F of
   * cells that overlap becomes smaller, F of cells with gaps between them
   * larger, so that the next step moves them apart or together. Only inside
   * the tissue: in grid cells that are nearly full, like all their neighbours.
   * doc/theory.md (6.9c).
   * @param occupancy of a configuration not long before
   * @param part      of the difference that is made up for, at most 1
   */
  template <int dim>
  void
  even_out_fill(Tissue<dim>          &tissue,
                const Occupancy<dim> &occupancy,
                const double          part);
} // namespace Morula

#endif
