// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/grid_cell_counts.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>

#include <algorithm>
#include <map>

namespace Morula
{
  namespace
  {
    /** One count for each grid cell, in order. */
    GridCellCounts
    merged(GridCellCounts counts)
    {
      // Counts of a grid cell may come from several ranks and several times
      // from one. Sorted, they are neighbours.
      std::sort(counts.begin(),
                counts.end(),
                [](const GridCellCount &a, const GridCellCount &b) {
                  return a.number < b.number;
                });
      GridCellCounts result;
      for (const GridCellCount &count : counts)
        if (result.empty() || result.back().number != count.number)
          result.push_back(count);
        else
          result.back().n += count.n;
      return result;
    }
  } // namespace

  template <int dim>
  GridCellCounts
  sum_at_owners(const GridCellCounts  &counts,
                const GridBox<dim>    &box,
                const GridOwners<dim> &owners,
                const MPI_Comm         comm)
  {
    // On one rank there is nobody to ask. Else each count goes to the owner of
    // its grid cell, as two numbers.
    if (Utilities::MPI::n_mpi_processes(comm) == 1)
      return merged(counts);
    const unsigned int rank = Utilities::MPI::this_mpi_process(comm);
    GridCellCounts     own;
    std::map<unsigned int, std::vector<unsigned int>> numbers_and_counts;
    for (const GridCellCount &count : counts)
      if (const unsigned int owner = owners(box.index(count.number));
          owner == rank)
        own.push_back(count);
      else
        for (const unsigned int value : {count.number, count.n})
          numbers_and_counts[owner].push_back(value);
    for (const auto &[sender, list] :
         Utilities::MPI::some_to_some(comm, numbers_and_counts))
      for (std::size_t i = 0; i < list.size(); i += 2)
        own.push_back({list[i], list[i + 1]});
    return merged(std::move(own));
  }

  MORULA_INSTANTIATE(sum_at_owners);
} // namespace Morula
