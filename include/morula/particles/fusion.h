// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_fusion_h
#define morula_particles_fusion_h

#include <morula/particles/tissue.h>

#include <map>
#include <vector>

namespace Morula
{
  /** What fuses after a step. */
  struct Fusion
  {
    /** Into which body a body goes that fuses, by its number; of all ranks. */
    std::map<unsigned int, unsigned int> into;
    /** This rank's boundary points that others face which are to fuse with
     *  them, by their numbers in the store, increasing. */
    std::vector<unsigned int> points;
  };

  /** Takes the surface away that two strands have had between them, so that
   *  bonds form there: doc/theory.md, section 4.3a. Collective. */
  template <int dim>
  void
  remove_fused_surface(const Fusion &fusion, Tissue<dim> &tissue);

  /** Gives cells and boundary points of bodies that fuse their new body. The
   *  surface between them is still there. Collective. */
  template <int dim>
  void
  fuse_bodies(const Fusion &fusion, Tissue<dim> &tissue);
} // namespace Morula

#endif
