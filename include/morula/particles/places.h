// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_places_h
#define morula_particles_places_h

#include <morula/particles/tissue.h>

#include <vector>

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


  /** How full the space around the cells of this rank is, in their order. */
  struct SpaceOfCells
  {
    /** φ: the volume of the cells around in parts of the space there. */
    std::vector<double> fill;
    /** t, from 0 to 1: the part of the space around that is inside the body. */
    std::vector<double> inside;
  };

  /**
   * φ and t of doc/theory.md (6.11b), for each body by itself. The same on any
   * number of ranks. Collective.
   */
  template <int dim>
  SpaceOfCells
  space_of_cells(const Tissue<dim> &tissue);
} // namespace Morula

#endif
