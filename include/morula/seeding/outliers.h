// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_outliers_h
#define morula_seeding_outliers_h

#include <morula/seeding/points_file_rows.h>
#include <morula/seeding/seeding.h>

#include <deal.II/base/bounding_box.h>

#include <mpi.h>

namespace Morula
{
  using namespace dealii;

  /** The box around the rows of all ranks, µm. There must be at least one row.
   *  Collective. */
  template <int dim>
  BoundingBox<dim>
  bounding_box(const PointsFileRows<dim> &rows, const MPI_Comm comm);

  /** The problem of this rank's first row whose position or volume exceeds the
   *  limits, if there is one. */
  template <int dim>
  LineProblem
  find_row_beyond_limits(const PointsFileRows<dim> &rows,
                         const SeedingLimits<dim>  &limits);

  /**
   * If the rows of all ranks reach farther along an axis than @p extent (µm),
   * the problem of the row that is farthest from their mean. Only the rank that
   * holds that row returns it. Collective.
   * @param n number of rows on all ranks
   */
  template <int dim>
  LineProblem
  find_outlier(const PointsFileRows<dim> &rows,
               const double               extent,
               const std::uint64_t        n,
               const MPI_Comm             comm);
} // namespace Morula

#endif
