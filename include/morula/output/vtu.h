// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_vtu_h
#define morula_output_vtu_h

#include <morula/output/point_fields.h>

#include <mpi.h>

#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * Writes one VTU file, uncompressed, with a piece for each part. It appears
   * when it is complete.
   * @param parts  of the ranks
   * @param time   day
   * @param number of the file in its series
   * @throws std::runtime_error with path and reason
   */
  template <int dim>
  void
  write_vtu(const std::string                   &path,
            const std::vector<PointFields<dim>> &parts,
            const double                         time,
            const unsigned int                   number);

  /**
   * Writes the ParaView record of a series: times (day) and file names relative
   * to the record. Files that are not there (the format was switched on later)
   * are left out. Collective.
   * @throws std::runtime_error, on all ranks, with path and reason
   */
  void
  write_pvd(const std::string                                 &path,
            const std::vector<std::pair<double, std::string>> &times_and_names,
            const MPI_Comm                                     comm);
} // namespace Morula

#endif
