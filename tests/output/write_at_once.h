// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_output_write_at_once_h
#define morula_tests_output_write_at_once_h

#include <morula/output/background_files.h>
#include <morula/output/csv.h>
#include <morula/output/vtu.h>

#include <utility>

namespace Morula
{
  /** Writes what begin_vtu() or begin_csv() has begun, on all ranks. */
  inline void
  write_at_once(std::unique_ptr<PendingFile> file)
  {
    std::vector<std::unique_ptr<PendingFile>> files;
    files.push_back(std::move(file));
    BackgroundFiles(MPI_COMM_WORLD).start(std::move(files), true);
  }

  template <int dim>
  void
  write_vtu(const std::string      &path,
            const PointFields<dim> &fields,
            const double            time,
            const unsigned int      number,
            const std::uint64_t     shared_from = PartOfFile::worth_while)
  {
    write_at_once(
      begin_vtu(path, fields, time, number, MPI_COMM_WORLD, shared_from));
  }

  template <int dim>
  void
  write_csv(const std::string      &path,
            const PointFields<dim> &fields,
            const std::uint64_t     shared_from = PartOfFile::worth_while)
  {
    write_at_once(begin_csv(path, fields, MPI_COMM_WORLD, shared_from));
  }
} // namespace Morula

#endif
