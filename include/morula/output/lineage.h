// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_lineage_h
#define morula_output_lineage_h

#include <morula/particles/birth.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace Morula
{
  /** The columns of lineage.csv. @param with_types whether cells have types */
  std::vector<std::string>
  lineage_columns(const bool with_types);

  /**
   * The next rows of lineage.csv, on rank 0. The table has one for each cell
   * that ever lived: all ranks' births since the last call, in id order. Their
   * ids follow those in the file. Collective.
   * @param births of this rank, in any order
   */
  template <int dim>
  std::string
  lineage_rows(const std::vector<Birth<dim>> &births,
               const bool                     with_types,
               const MPI_Comm                 comm);
} // namespace Morula

#endif
