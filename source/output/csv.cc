// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/atomic_file.h>
#include <morula/output/csv.h>
#include <morula/output/csv_rows.h>

namespace Morula
{
  template <int dim>
  void
  write_csv(const std::string      &path,
            const PointFields<dim> &fields,
            const MPI_Comm          comm)
  {
    CsvRows local;
    for (std::size_t i = 0; i < fields.size(); ++i)
      local.add(fields.ids[i], fields.row(i), fields.n_csv_columns);
    const GatheredRows rows(local, comm);

    on_root(comm, [&]() {
      AtomicFile file(path);
      file.write(csv_header(
        {fields.names.begin(), fields.names.begin() + fields.n_csv_columns}));
      for (const std::string_view row : rows.in_id_order())
        file.write(row);
      file.commit();
    });
  }

  template void
  write_csv<2>(const std::string &, const PointFields<2> &, const MPI_Comm);
  template void
  write_csv<3>(const std::string &, const PointFields<3> &, const MPI_Comm);
} // namespace Morula
