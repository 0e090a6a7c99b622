// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_even_fill_h
#define morula_particles_even_fill_h

#include <morula/grid/occupancy.h>
#include <morula/particles/tissue.h>

namespace Morula
{
  /**
   * Adapts the volumes of cells to the space that they take: it makes F smaller
   * if cells overlap and larger if there are gaps between them, so that the
   * next step moves them apart or together. Only inside the tissue: in grid
   * cells that are nearly full, like all their neighbours. doc/theory.md
   * (6.9c).
   * @param occupancy of a configuration not long before
   * @param part      fraction of the difference that is removed, at most 1
   */
  template <int dim>
  void
  relax_volumes_to_space(Tissue<dim>          &tissue,
                         const Occupancy<dim> &occupancy,
                         const double          part,
                         const unsigned int    body = 0);
} // namespace Morula

#endif
