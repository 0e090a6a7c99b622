// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_points_file_h
#define morula_seeding_points_file_h

#include <morula/seeding/seeding.h>

#include <mpi.h>

#include <string>

namespace Morula
{
  using namespace dealii;

  /**
   * Reads this rank's part of the cells in a CSV file with a header line naming
   * the columns, in any order: x, y (3-D: and z), in µm, and volume, in
   * µm^dim. Without volumes, every cell has @p default_volume. In 2-D a column
   * z may stand, all zero. Blank lines and lines that begin with # do not
   * count; rows are ids in order. Every rank reads only its share of the file.
   * Collective.
   * @throws InputError on all ranks, naming the file's first bad line: numbers
   * that are none, wrong columns, volumes that are not positive, two cells at
   * one place, a cell beyond the limits or far away from all others, no cells
   */
  template <int dim>
  Founders<dim>
  read_points(const std::string        &file,
              const double              default_volume,
              const MPI_Comm            comm,
              const SeedingLimits<dim> &limits = {});
} // namespace Morula

#endif
