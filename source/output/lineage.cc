// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>
#include <morula/output/lineage.h>

#include <array>

namespace Morula
{
  namespace
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
  } // namespace

  template <int dim>
  LineageFile<dim>::LineageFile(const std::string &path,
                                const bool         with_types,
                                const MPI_Comm     comm)
    : comm(comm)
    , with_types(with_types)
    , file(path, lineage_columns(with_types), comm)
  {}

  template <int dim>
  LineageFile<dim>::LineageFile(const std::string &path,
                                const bool         with_types,
                                const TableExtent &kept,
                                const MPI_Comm     comm)
    : comm(comm)
    , with_types(with_types)
    , file(path, lineage_columns(with_types), kept, comm)
  {}

  template <int dim>
  void
  LineageFile<dim>::check(const std::string &path,
                          const bool         with_types,
                          const TableExtent &kept,
                          const MPI_Comm     comm)
  {
    AppendedCsv::check(path, lineage_columns(with_types), kept, comm);
  }

  template <int dim>
  void
  LineageFile<dim>::append(const std::vector<Birth<dim>> &births)
  {
    CsvRows local;
    for (const Birth<dim> &birth : births)
      {
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
        local.add(birth.id, values.data(), with_types ? 8 : 7);
      }

    const GatheredRows rows(local, comm);
    std::string        text;
    for (const std::string_view row : rows.in_id_order())
      text += row;
    file.append(text);
  }

  template class LineageFile<2>;
  template class LineageFile<3>;
} // namespace Morula
