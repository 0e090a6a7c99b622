// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/output/csv_rows.h>
#include <morula/output/lineage.h>

#include <array>
#include <utility>

namespace Morula
{
  std::vector<std::string>
  lineage_columns(const bool with_types)
  {
    std::vector<std::string> columns = {
      "id", "parent", "generation", "birth_time", "x", "y", "z"};
    if (with_types)
      columns.push_back("type");
    return columns;
  }

  template <int dim>
  std::string
  lineage_rows(const std::vector<Birth<dim>> &births,
               const bool                     with_types,
               const MPI_Comm                 comm)
  {
    std::vector<std::string>           rows;
    std::vector<types::particle_index> ids;
    for (const Birth<dim> &birth : births)
      {
        // In 2-D z is 0.
        std::array<double, 8> values = {{static_cast<double>(birth.id),
                                         static_cast<double>(birth.parent),
                                         static_cast<double>(birth.generation),
                                         birth.time,
                                         0.,
                                         0.,
                                         0.,
                                         static_cast<double>(birth.type)}};
        for (unsigned int d = 0; d < dim; ++d)
          values[4 + d] = birth.position[d];
        // Without types the last value is left out.
        rows.push_back(csv_row(values.data(), with_types ? 8 : 7));
        ids.push_back(birth.id);
      }

    return rows_in_order(std::move(ids), rows, comm);
  }

  MORULA_INSTANTIATE(lineage_rows);
} // namespace Morula
