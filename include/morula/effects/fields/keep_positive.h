// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fields_keep_positive_h
#define morula_effects_fields_keep_positive_h

#include <morula/grid/spline_space.h>
#include <morula/mechanics/material_points.h>

#include <mpi.h>

#include <cstdint>
#include <vector>

namespace Morula
{
  /**
   * Sets negative values of cells to zero, and makes others smaller so that the
   * sum of weights times values stays: those of the same grid cell, and where
   * they do not suffice, those of grid cells with the same splines, and last
   * all. Only a sum that is negative becomes zero. doc/theory.md, section 11.3.
   * Collective.
   * @param values  by cell
   * @param weights by cell, >= 0; where they are 0 nothing is made smaller
   * @param places  of the cells in the grid cells of @p space
   * @return negative values on all ranks
   */
  template <int dim>
  std::uint64_t
  keep_positive(std::vector<double>       &values,
                const std::vector<double> &weights,
                const GroupedPoints<dim>  &places,
                const SplineSpace<dim>    &space,
                const MPI_Comm             comm);
} // namespace Morula

#endif
