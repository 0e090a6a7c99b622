// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/simulation/former_columns.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Columns that are only written out, and found in every step. */
    const std::set<std::string> found_in_steps = {"force", "contact_pressure"};

    /** A column of a former layout: its place in the row, and its length. */
    struct FormerColumn
    {
      unsigned int first, n;
    };
  } // namespace


  template <int dim>
  std::string
  add_former_columns(const Columns     &boundary_columns,
                     const MPI_Comm     comm,
                     SnapshotData<dim> &data)
  {
    // A snapshot is only changed if nothing but such columns is missing; else
    // it is refused with the columns that differ. Each row is put together in
    // the order of the columns of now.
    if (data.boundary_columns.empty())
      return "";
    std::map<std::string, FormerColumn> former;
    std::istringstream                  lines(data.boundary_columns);
    std::string                         name, names;
    unsigned int                        length = 0;
    for (unsigned int n = 0; lines >> name >> n; length += n)
      former[name] = {length, n};
    std::size_t n_known = 0;
    for (const Columns::Entry &entry : boundary_columns.entries())
      if (const auto found = former.find(entry.name); found != former.end())
        {
          if (found->second.n != entry.n)
            return "";
          ++n_known;
        }
      else if (found_in_steps.count(entry.name) > 0)
        names += (names.empty() ? "" : ", ") + entry.name;
      else
        return "";
    PointList<dim> &points = data.boundary_points;
    const bool      is_sound =
      points.size() == 0 || (points.n_numbers == length &&
                             points.numbers.size() == points.size() * length);
    if (names.empty() || n_known != former.size() ||
        Utilities::MPI::min(int(is_sound), comm) == 0)
      return "";
    std::vector<double> rows;
    for (std::size_t i = 0; i < points.size(); ++i)
      for (const Columns::Entry &entry : boundary_columns.entries())
        if (const auto found = former.find(entry.name); found != former.end())
          {
            const double *const begin =
              &points.numbers[i * length + found->second.first];
            rows.insert(rows.end(), begin, begin + entry.n);
          }
        else
          rows.insert(rows.end(), entry.n, 0.);
    points.numbers        = std::move(rows);
    points.n_numbers      = boundary_columns.n_numbers();
    data.boundary_columns = boundary_columns.layout();
    return names;
  }


  MORULA_INSTANTIATE(add_former_columns);
} // namespace Morula
