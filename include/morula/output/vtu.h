// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_vtu_h
#define morula_output_vtu_h

#include <morula/output/point_fields.h>
#include <morula/output/shared_file.h>

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * Begins one VTU file for all ranks, one piece a rank, all columns of the
   * fields as point data: in single precision, or as integers of 32 bits. The
   * file is XML throughout, with the data in base64, and appears when it is
   * complete. Collective.
   * @param time   day, for ParaView's annotation
   * @param number of the file in its series
   * @param shared_from size, bytes, from which on several ranks write the file
   *        together if the file system allows that; else rank 0 does, group by
   *        group of columns. The file is the same.
   * @return the file with the fields that are to be written; nullptr, on all
   *   ranks, if rank 0 has written the file
   * @throws std::runtime_error, on all ranks, with path and reason
   */
  template <int dim>
  std::unique_ptr<PendingFile>
  begin_vtu(const std::string  &path,
            PointFields<dim>    fields,
            const double        time,
            const unsigned int  number,
            const MPI_Comm      comm,
            const std::uint64_t shared_from = PartOfFile::worth_while);

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
