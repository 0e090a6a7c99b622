// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/csv_rows.h>
#include <morula/output/matrix_condition.h>

namespace Morula
{
  namespace
  {
    const std::vector<std::string> names = {
      "step", "time", "unknowns", "smallest", "largest", "condition"};
  }

  MatrixConditionFile::MatrixConditionFile(const std::string &path,
                                           const MPI_Comm     comm)
    : file(path, names, comm)
  {}

  MatrixConditionFile::MatrixConditionFile(const std::string &path,
                                           const TableExtent &kept,
                                           const MPI_Comm     comm)
    : file(path, names, kept, comm)
  {}

  void
  MatrixConditionFile::check(const std::string &path,
                             const TableExtent &kept,
                             const MPI_Comm     comm)
  {
    AppendedCsv::check(path, names, kept, comm);
  }

  void
  MatrixConditionFile::append(const unsigned int       step,
                              const double             time,
                              const ConditionEstimate &estimate)
  {
    const std::vector<double> values = {double(step),
                                        time,
                                        double(estimate.unknowns),
                                        estimate.smallest,
                                        estimate.largest,
                                        estimate.condition()};
    CsvRows                   rows;
    rows.add(step, values.data(), values.size());
    file.append(rows.text);
  }
} // namespace Morula
