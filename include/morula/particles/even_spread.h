// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_even_spread_h
#define morula_particles_even_spread_h

#include <morula/grid/occupancy.h>
#include <morula/particles/tissue.h>

#include <vector>

namespace Morula
{
  /** In this time, day, a cell moves by a part of what evens its surroundings
   *  out, if it spreads fully. */
  constexpr double spreading_time = 0.125;

  /**
   * Moves cells from where their volumes overlap to where they leave gaps,
   * inside their body's surface: doc/theory.md (6.9e). Volumes, strains and the
   * surface stay, and so do cells that are several points. Collective.
   *
   * @param dt    length of the step, day
   * @param parts of each cell of this rank, from 0, where it stays, to 1
   */
  template <int dim>
  void
  spread_cells(Tissue<dim>               &tissue,
               const double               dt,
               const std::vector<double> &parts);

  /** Spreads cells as far as growth is uneven among those that share splines.
   *  Collective. */
  template <int dim>
  void
  spread_uneven_growth(Tissue<dim> &tissue, const double dt);


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
