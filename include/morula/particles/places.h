// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_places_h
#define morula_particles_places_h

#include <morula/particles/tissue.h>

namespace Morula
{
  /**
   * Moves cells of a body apart that are nearer to each other than their
   * volumes allow, inside their body's surface, as far as the strain of the
   * step asks for it: doc/theory.md (6.11a). Volumes, deformations and the
   * surface stay. The same on any number of ranks. Collective.
   * @return the share of all cells that have a neighbour nearer than
   *         0.4 V^(1/dim) then
   */
  template <int dim>
  double
  keep_apart(Tissue<dim> &tissue);
} // namespace Morula

#endif
