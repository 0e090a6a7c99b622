// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_step_checks_h
#define morula_simulation_step_checks_h

#include <morula/mechanics/displacement_field.h>
#include <morula/particles/point_store.h>

#include <string>

namespace Morula
{
  /** Whether the field turns any of the points' neighbourhoods inside out, on
   *  any rank. Collective. */
  template <int dim>
  bool
  inverts(const DisplacementField<dim> &displacement,
          const PointStore<dim>        &store,
          const MPI_Comm                comm);

  /**
   * Why the tissue does not fit on the grid any more: some points have moved so
   * far from the others that tables over all grid cells between them, many more
   * than in the present @p box, would fill the memory. Empty if it fits.
   * Positions in µm. Collective.
   */
  template <int dim>
  std::string
  why_torn(const std::vector<Point<dim>> &cells,
           const std::vector<Point<dim>> &boundary_points,
           const GridBox<dim>            &box,
           const MPI_Comm                 comm);
} // namespace Morula

#endif
