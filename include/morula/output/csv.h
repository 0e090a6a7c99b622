// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_csv_h
#define morula_output_csv_h

#include <morula/output/point_fields.h>
#include <morula/output/shared_file.h>

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <string>

namespace Morula
{
  /**
   * Begins one CSV file for all ranks: a header, then the rows in the order of
   * their ids, so that the file is the same for any number of ranks. The file
   * appears when it is complete. Collective.
   * @param shared_from size, bytes, from which on several ranks write the file
   *        together if the file system allows that; else rank 0 does
   * @return the file in two stages: its text is made, then written
   * @throws std::runtime_error, on all ranks, with path and reason
   */
  template <int dim>
  std::unique_ptr<PendingFile>
  begin_csv(const std::string      &path,
            const PointFields<dim> &fields,
            const MPI_Comm          comm,
            const std::uint64_t     shared_from = PartOfFile::worth_while);
} // namespace Morula

#endif
