// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_outliers_h
#define morula_seeding_outliers_h

#include <morula/seeding/point_rows.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/bounding_box.h>

#include <mpi.h>

namespace Morula
{
  using namespace dealii;

  /** The box around all rows, of which there is at least one; µm. Collective.
   */
  template <int dim>
  BoundingBox<dim>
  bounding_box(const PointRows<dim> &rows, const MPI_Comm comm);

  /** This rank's first row whose position or volume is beyond the limits. */
  template <int dim>
  LineProblem
  find_beyond(const PointRows<dim> &rows, const SeedingLimits<dim> &limits);

  /**
   * If the rows of all ranks, @p n of them, reach farther along an axis than
   * @p extent (µm), the one that is farthest from their mean. Collective; only
   * the rank that has it returns it.
   */
  template <int dim>
  LineProblem
  find_outlier(const PointRows<dim> &rows,
               const double          extent,
               const std::uint64_t   n,
               const MPI_Comm        comm);
} // namespace Morula

#endif
