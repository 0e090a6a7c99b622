// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/particles/uneven_growth.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Differences of ln det F_g that are rounding. */
    constexpr double slightest_difference = 1e-9;

    /** ln det F_g of cell @p p. Divisions do not change it. */
    template <int dim>
    double
    log_growth(const Cells<dim> &cells, const unsigned int p)
    {
      return std::log(determinant(cells.growth(p)));
    }
  } // namespace


  template <int dim>
  UnevenGrowth<dim>::UnevenGrowth(const Tissue<dim> &tissue)
    : grid(tissue.grid())
  {
    const Cells<dim> &cells = tissue.cells();
    double            least = std::numeric_limits<double>::max(), most = -least;
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const double growth = log_growth(cells, p);
        least               = std::min(least, growth);
        most                = std::max(most, growth);
      }
    exists_ = Utilities::MPI::max(most, tissue.communicator()) -
                Utilities::MPI::min(least, tissue.communicator()) >
              slightest_difference;
    if (exists_)
      sum(cells);
  }


  template <int dim>
  void
  UnevenGrowth<dim>::sum(const Cells<dim> &cells)
  {
    // A rank has all cells of its grid cells. So it sums over each of them, and
    // sends the sums to the ranks with grid cells that share splines with it.
    struct GridCell
    {
      GridIndex<dim> index;
      Sums           sums{};
    };
    std::map<unsigned int, GridCell> own;
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        const GridIndex<dim> index  = grid.box().locate(cells.position(p));
        GridCell            &one    = own[grid.box().number(index)];
        const double         V      = cells.volume(p);
        const double         growth = log_growth(cells, p);
        one.index                   = index;
        one.sums[0] += V;
        one.sums[1] += V * growth;
        one.sums[2] += V * growth * growth;
      }
    std::map<unsigned int, std::vector<GridCell>> by_rank;
    for (const auto &[number, one] : own)
      {
        std::set<unsigned int> ranks;
        grid.box().for_neighbors(one.index,
                                 reach,
                                 [&](const unsigned int, const auto &other) {
                                   ranks.insert(grid.owner(other));
                                 });
        for (const unsigned int rank : ranks)
          by_rank[rank].push_back(one);
      }
    for (const auto &[sender, list] :
         send_records(by_rank, grid.communicator()))
      for (const GridCell &one : list)
        sums[grid.box().number(one.index)] = one.sums;
  }


  template <int dim>
  double
  UnevenGrowth<dim>::variance(const Point<dim> &x) const
  {
    Sums all{};
    grid.box().for_neighbors(grid.box().locate(x),
                             reach,
                             [&](const unsigned int number, const auto &) {
                               const auto found = sums.find(number);
                               if (found != sums.end())
                                 for (unsigned int k = 0; k < all.size(); ++k)
                                   all[k] += found->second[k];
                             });
    const double mean = all[1] / all[0];
    return std::max(0., all[2] / all[0] - mean * mean);
  }

  template class UnevenGrowth<2>;
  template class UnevenGrowth<3>;
} // namespace Morula
