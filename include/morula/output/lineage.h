// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_lineage_h
#define morula_output_lineage_h

#include <morula/output/appended_csv.h>
#include <morula/particles/birth.h>

#include <deal.II/base/point.h>
#include <deal.II/particles/property_pool.h>

#include <string>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * lineage.csv: one row per cell that ever lived, in id order. All members are
   * collective; errors as in AppendedCsv.
   */
  template <int dim>
  class LineageFile
  {
  public:
    /** A new file. @param with_types whether cells have types */
    LineageFile(const std::string &path,
                const bool         with_types,
                const MPI_Comm     comm);

    /** Continues the file behind the rows that are to be @p kept. */
    LineageFile(const std::string &path,
                const bool         with_types,
                const TableExtent &kept,
                const MPI_Comm     comm);

    /** See AppendedCsv. */
    static void
    check(const std::string &path,
          const bool         with_types,
          const TableExtent &kept,
          const MPI_Comm     comm);

    /**
     * Appends all ranks' births since the last call; their ids follow those in
     * the file, in any order and on any rank.
     */
    void
    append(const std::vector<Birth<dim>> &births);

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
    MPI_Comm    comm;
    bool        with_types;
    AppendedCsv file;
  };
} // namespace Morula

#endif
