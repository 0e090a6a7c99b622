// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/effects/fate/left_amounts.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi.templates.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <iterator>
#include <limits>

namespace Morula
{
  template <int dim>
  void
  give_to_nearest(Tissue<dim>                         &tissue,
                  const std::vector<unsigned int>     &gone,
                  const std::vector<Column<double>>   &carried,
                  const std::vector<LeftAmounts<dim>> &left)
  {
    // All ranks get what all leave, which is rare and little. Each looks for
    // its own nearest cell that stays; the nearest of all ranks counts, and of
    // cells that are equally near that with the lowest id, so that the number
    // of ranks does not matter.
    const MPI_Comm      comm = tissue.communicator();
    std::vector<double> mine;
    for (const LeftAmounts<dim> &one : left)
      {
        for (unsigned int d = 0; d < dim; ++d)
          mine.push_back(one.position[d]);
        mine.insert(mine.end(), one.amounts.begin(), one.amounts.end());
      }
    std::vector<double> all;
    for (const auto &list : Utilities::MPI::all_gather(comm, mine))
      all.insert(all.end(), list.begin(), list.end());
    const std::size_t length = dim + carried.size();
    const std::size_t n      = all.size() / length;
    if (n == 0)
      return;

    const Cells<dim>         &cells = tissue.cells();
    std::vector<unsigned int> staying;
    std::vector<Point<dim>>   positions;
    for (unsigned int p = 0; p < cells.size(); ++p)
      if (!std::binary_search(gone.begin(), gone.end(), p))
        {
          staying.push_back(p);
          positions.push_back(cells.position(p));
        }
    const auto                tree = pack_rtree_of_indices(positions);
    std::vector<double>       distance(n, std::numeric_limits<double>::max());
    std::vector<double>       id(n, std::numeric_limits<double>::max());
    std::vector<unsigned int> nearest(n);
    constexpr unsigned int    most_alike = 12; // in a lattice, in 3-D
    for (std::size_t k = 0; k < n; ++k)
      {
        Point<dim> x;
        for (unsigned int d = 0; d < dim; ++d)
          x[d] = all[k * length + d];
        std::vector<std::size_t> found;
        tree.query(boost::geometry::index::nearest(x, most_alike),
                   std::back_inserter(found));
        for (const std::size_t i : found)
          {
            const double way = x.distance(positions[i]);
            const double its = cells.id(staying[i]);
            if (way < distance[k] || (way == distance[k] && its < id[k]))
              {
                distance[k] = way;
                id[k]       = its;
                nearest[k]  = staying[i];
              }
          }
      }
    std::vector<double> least(n), lowest(id);
    Utilities::MPI::min(distance, comm, least);
    for (std::size_t k = 0; k < n; ++k)
      if (distance[k] > least[k])
        lowest[k] = std::numeric_limits<double>::max();
    Utilities::MPI::min(lowest, comm, lowest);
    for (std::size_t k = 0; k < n; ++k)
      if (distance[k] == least[k] && id[k] == lowest[k] &&
          distance[k] < std::numeric_limits<double>::max())
        {
          const CellView<dim, double> cell = tissue.cell(nearest[k]);
          for (std::size_t c = 0; c < carried.size(); ++c)
            cell.set(carried[c],
                     cell.get(carried[c]) +
                       all[k * length + dim + c] / cell.volume());
        }
  }


  MORULA_INSTANTIATE(give_to_nearest);
} // namespace Morula
