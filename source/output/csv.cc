// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/csv.h>
#include <morula/output/csv_rows.h>
#include <morula/output/gather.h>
#include <morula/output/shared_file.h>

#include <deal.II/base/mpi.h>

namespace Morula
{
  namespace
  {
    void
    write_together(SharedFile        &file,
                   const std::string &header,
                   const std::string &text,
                   const MPI_Comm     comm)
    {
      const std::uint64_t n_own  = text.size();
      std::uint64_t       before = 0; // stays on rank 0
      const int           error =
        MPI_Exscan(&n_own, &before, 1, MPI_UINT64_T, MPI_SUM, comm);
      AssertThrowMPI(error);
      everywhere(comm, [&]() {
        if (Utilities::MPI::this_mpi_process(comm) == 0)
          file.write(header, 0);
        file.write(text, header.size() + before);
      });
      file.commit();
    }
  } // namespace

  template <int dim>
  void
  write_csv(const std::string      &path,
            const PointFields<dim> &fields,
            const MPI_Comm          comm,
            const std::uint64_t     shared_from)
  {
    CsvRows rows;
    for (std::size_t i = 0; i < fields.size(); ++i)
      rows.add(csv_row(fields.row(i), fields.n_csv_columns));
    const std::string text =
      rows.share_in_order(global_order(fields.ids, comm), comm);
    const std::string header = csv_header(
      {fields.names.begin(), fields.names.begin() + fields.n_csv_columns});

    const std::uint64_t size =
      header.size() + Utilities::MPI::sum(std::uint64_t(text.size()), comm);
    if (Utilities::MPI::n_mpi_processes(comm) > 1 && size >= shared_from)
      {
        SharedFile file(path, size, comm);
        if (file.is_shared())
          {
            write_together(file, header, text, comm);
            return;
          }
      }
    const auto parts = gather_to_root(text, comm);
    on_root(comm, [&]() {
      AtomicFile file(path);
      file.write(header);
      for (const std::string &part : parts)
        file.write(part);
      file.commit();
    });
  }

  template void
  write_csv<2>(const std::string &,
               const PointFields<2> &,
               const MPI_Comm,
               const std::uint64_t);
  template void
  write_csv<3>(const std::string &,
               const PointFields<3> &,
               const MPI_Comm,
               const std::uint64_t);
} // namespace Morula
