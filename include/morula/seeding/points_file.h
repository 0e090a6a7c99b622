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
   * Reads this rank's part of the cells in a CSV file. Its header line names
   * the columns in any order: x, y, in 3-D z, in µm, volume, in µm^dim,
   * generation, phase and type; others are skipped. Entries are separated by
   * commas. Without a column of volumes every cell has @p default_volume. In
   * 2-D a column z is allowed if it holds only zeros. Blank lines and lines
   * that begin with # are skipped. The order of the rows is the order of the
   * ids. Rank 0 reads the file. Collective.
   * @throws InputError on all ranks with the file's first bad line and column:
   * values that are no numbers, wrong columns, volumes that are not positive,
   * generations that are no whole number, a cell beyond the limits, a second
   * moment; then for two cells at one place, a cell far away from all others,
   * and a file without cells
   */
  template <int dim>
  Founders<dim>
  read_points(const std::string        &file,
              const double              default_volume,
              const MPI_Comm            comm,
              const SeedingLimits<dim> &limits = {});
} // namespace Morula

#endif
