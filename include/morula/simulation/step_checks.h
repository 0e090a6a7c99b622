// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_step_checks_h
#define morula_simulation_step_checks_h

#include <morula/mechanics/momentum_balance.h>
#include <morula/mechanics/spline_field.h>
#include <morula/particles/point_store.h>

#include <string>

namespace Morula
{
  /** Whether det f ≤ 0 at any point of any rank: the displacement turns the
   *  point's neighbourhood inside out. Collective. */
  template <int dim>
  bool
  inverts(const DisplacementField<dim> &displacement,
          const PointStore<dim>        &store,
          const MPI_Comm                comm);

  /**
   * Refuses a step in which the tissue slips through its clamp: a held point is
   * more than @p largest_gap grid spacings @p h (µm) from where it is held.
   * With 0 any gap is allowed.
   * @throws StepFailed
   */
  template <int dim>
  void
  check_gap(const Extremes<dim> &extremes,
            const double         largest_gap,
            const double         h);

  /**
   * A message if the tissue does not fit on the grid any more, otherwise empty.
   * If some points move very far from the others, the tables over all grid
   * cells between them, many more than in the present @p box, would fill the
   * memory. Positions in µm. Collective.
   */
  template <int dim>
  std::string
  torn_tissue_message(const std::vector<Point<dim>> &cells,
                      const std::vector<Point<dim>> &boundary_points,
                      const GridBox<dim>            &box,
                      const MPI_Comm                 comm);
} // namespace Morula

#endif
