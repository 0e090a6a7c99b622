// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_events_h
#define morula_output_events_h

#include <morula/output/appended_csv.h>
#include <morula/particles/type_change.h>

#include <string>
#include <vector>

namespace Morula
{
  /** events.csv: one row for each change of a cell's type, ordered by time,
   *  then by the cell's id. All members are collective; errors as in
   *  AppendedCsv. */
  class EventsFile
  {
  public:
    /** A new file. @param type_names by the types' numbers */
    EventsFile(const std::string              &path,
               const std::vector<std::string> &type_names,
               const MPI_Comm                  comm);

    /** Continues the file behind the rows that are to be @p kept. */
    EventsFile(const std::string              &path,
               const std::vector<std::string> &type_names,
               const TableExtent              &kept,
               const MPI_Comm                  comm);

    /** See AppendedCsv. */
    static void
    check(const std::string &path,
          const TableExtent &kept,
          const MPI_Comm     comm);

    /** Appends what happened on all ranks in a step, in any order. */
    void
    append(const std::vector<TypeChange> &changes);

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
    std::vector<std::string> type_names;
    MPI_Comm                 comm;
    AppendedCsv              file;
  };
} // namespace Morula

#endif
