// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_matrix_condition_h
#define morula_output_matrix_condition_h

#include <morula/output/appended_csv.h>
#include <morula/solver/condition_estimate.h>

namespace Morula
{
  /**
   * condition.csv: the condition of the tangent matrix, with the columns
   * `step,time,unknowns,smallest,largest,condition`. Each step has one row. Its
   * time (day) is that of the step's beginning, where the tangent is taken. All
   * members are collective and throw as those of AppendedCsv.
   */
  class MatrixConditionFile
  {
  public:
    /** Starts a new file. */
    MatrixConditionFile(const std::string &path, const MPI_Comm comm);

    /** Continues the file behind the rows that are to be @p kept. */
    MatrixConditionFile(const std::string &path,
                        const TableExtent &kept,
                        const MPI_Comm     comm);

    /** See AppendedCsv. */
    static void
    check(const std::string &path,
          const TableExtent &kept,
          const MPI_Comm     comm);

    /** Appends the row of a step. */
    void
    append(const unsigned int       step,
           const double             time,
           const ConditionEstimate &estimate);

    /** See AppendedCsv. */
    void
    sync()
    {
      file.sync();
    }

    TableExtent
    extent() const
    {
      return file.extent();
    }

  private:
    AppendedCsv file;
  };
} // namespace Morula

#endif
