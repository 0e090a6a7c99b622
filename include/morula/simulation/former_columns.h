// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_former_columns_h
#define morula_simulation_former_columns_h

#include <morula/output/snapshot.h>
#include <morula/particles/columns.h>

#include <mpi.h>

#include <string>

namespace Morula
{
  /**
   * Gives the boundary points of a snapshot of an older program the columns
   * that it did not have and that every step finds anew. They are 0 until the
   * next step. Collective.
   * @return the names of these columns, separated by commas; empty: none lacks
   */
  template <int dim>
  std::string
  add_former_columns(const Columns     &boundary_columns,
                     const MPI_Comm     comm,
                     SnapshotData<dim> &data);
} // namespace Morula

#endif
