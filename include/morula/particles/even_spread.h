// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_even_spread_h
#define morula_particles_even_spread_h

#include <morula/particles/tissue.h>

namespace Morula
{
  /**
   * Moves cells from where their volumes overlap to where they leave gaps,
   * inside their body's surface, as far as growth is uneven among the cells
   * that share splines: doc/theory.md (6.9e). Volumes, strains and the surface
   * stay, and so do cells that are several points. Collective.
   *
   * @param dt length of the step, day
   */
  template <int dim>
  void
  spread_cells(Tissue<dim> &tissue, const double dt);
} // namespace Morula

#endif
