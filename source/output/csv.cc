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
  template <int dim>
  std::unique_ptr<PendingFile>
  begin_csv(const std::string      &path,
            const PointFields<dim> &fields,
            const MPI_Comm          comm,
            const std::uint64_t     shared_from)
  {
    // Rows are made on the rank that has the points, and then exchanged by id
    // so that each rank has an equal part of the file, in order. If all ranks
    // can write the file each writes its part from where lower ranks' end, in
    // the background. Else rank 0 gathers and writes at once. The bytes are the
    // same.
    CsvRows rows;
    for (std::size_t i = 0; i < fields.size(); ++i)
      rows.add(csv_row(fields.row(i), fields.n_csv_columns));
    std::string text =
      rows.share_in_order(global_order(fields.ids, comm), comm);
    if (Utilities::MPI::this_mpi_process(comm) == 0)
      text.insert(0,
                  csv_header({fields.names.begin(),
                              fields.names.begin() + fields.n_csv_columns}));

    const std::uint64_t n_own = text.size();
    auto                file  = SharedFile::make(path,
                                 Utilities::MPI::sum(n_own, comm),
                                 comm,
                                 shared_from);
    if (file == nullptr)
      {
        const auto parts = gather_to_root(std::move(text), comm);
        on_root(comm, [&]() {
          AtomicFile file(path);
          for (const std::string &part : parts)
            file.write(part);
          file.commit();
        });
        return nullptr;
      }
    // MPI_Exscan() leaves it alone on rank 0, which begins at 0.
    std::uint64_t before = 0; // stays on rank 0
    const int     error =
      MPI_Exscan(&n_own, &before, 1, MPI_UINT64_T, MPI_SUM, comm);
    AssertThrowMPI(error);
    return std::make_unique<PendingFile>(
      std::move(file), [before, text = std::move(text)](SharedFile &file) {
        file.write(text, before);
      });
  }

  template std::unique_ptr<PendingFile>
  begin_csv<2>(const std::string &,
               const PointFields<2> &,
               const MPI_Comm,
               const std::uint64_t);
  template std::unique_ptr<PendingFile>
  begin_csv<3>(const std::string &,
               const PointFields<3> &,
               const MPI_Comm,
               const std::uint64_t);
} // namespace Morula
