// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_even_spread_h
#define morula_particles_even_spread_h

#include <morula/particles/tissue.h>

namespace Morula
{
  /**
   * Moves cells from where their volumes overlap to where they leave gaps,
   * inside their body's surface: doc/theory.md (6.9d). Volumes, strains and the
   * surface stay. A cell that is several points stays, too. Where faces
   * meet in an edge, only the nearest counts as the end of the tissue: there
   * cells move towards the other one. Collective.
   */
  template <int dim>
  void
  spread_cells(Tissue<dim> &tissue, const double dt);
} // namespace Morula

#endif
