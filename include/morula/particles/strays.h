// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_strays_h
#define morula_particles_strays_h

#include <morula/particles/tissue.h>

#include <cstdint>
#include <vector>

namespace Morula
{
  /**
   * How far a cell's part of the tissue reaches, µm: 1.5 times its present
   * width |F_e| (V⁰ det F_g)^(1/dim), at least h/4. No surface of a lattice
   * of cells lies farther from it: doc/theory.md (4.13).
   * Boundary points farther from their nearest cell than that have left the
   * tissue.
   */
  template <int dim>
  double
  surface_reach(const CellView<dim, const double> &cell, const double h);

  /** 1 for boundary points at most @p reach away from their nearest cell, 0 for
   *  those at 4/3 of @p reach, linear between. */
  double
  trust_in_surface(const double distance, const double reach);

  /** The same for positions of boundary points on this rank. Collective. */
  template <int dim>
  std::vector<double>
  trust_in_surface(const std::vector<Point<dim>> &points,
                   const Tissue<dim>             &tissue);

  /**
   * Takes boundary points back that have left the tissue: where no cell is
   * near, the displacement is extrapolated, and a point that is ahead of the
   * tissue moves away from it ever faster. Such a point goes back towards its
   * nearest cell until it is within 4/3 of its reach, and takes over the
   * cell's deformation gradient. Fixed points stay where they are held, slip
   * points in their plane.
   * @return how many points were taken back, over all ranks. Collective.
   */
  template <int dim>
  std::uint64_t
  take_back_strays(Tissue<dim> &tissue);
} // namespace Morula

#endif
