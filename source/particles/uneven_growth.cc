// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/send_records.h>
#include <morula/particles/even_spread.h>
#include <morula/particles/tissue.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The variance of ln det F_g from which on growth is fully uneven: that of
     *  cells half of which are larger by a half than the others. */
    constexpr double fully_uneven = 0.04;

    /** Differences of ln det F_g that are rounding. */
    constexpr double slightest_difference = 1e-9;

    /** ln det F_g of cell @p p. Divisions do not change it. */
    template <int dim>
    double
    log_growth(const Cells<dim> &cells, const unsigned int p)
    {
      return std::log(determinant(cells.growth(p)));
    }

    /** How unevenly cells have grown that share splines: the s of doc/theory.md
     *  (6.9e). It refers to the tissue. */
    template <int dim>
    class UnevenGrowth
    {
    public:
      /** Knows the grid cells that share splines with those of this rank.
       *  Collective. */
      explicit UnevenGrowth(const Tissue<dim> &tissue)
        : grid(tissue.grid())
      {
        const Cells<dim> &cells = tissue.cells();
        double least = std::numeric_limits<double>::max(), most = -least;
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

      /** Whether any two cells of all ranks have grown differently. Where none
       *  have, all is even, and sums are not made. */
      bool
      exists() const
      {
        return exists_;
      }

      /** The variance of ln det F_g, by volume, of the cells that share splines
       *  with those in the grid cell at @p x, which has some. */
      double
      variance(const Point<dim> &x) const
      {
        Sums all{};
        grid.box().for_neighbors(grid.box().locate(x),
                                 reach,
                                 [&](const unsigned int number, const auto &) {
                                   const auto found = sums.find(number);
                                   if (found != sums.end())
                                     for (unsigned int k = 0; k < all.size();
                                          ++k)
                                       all[k] += found->second[k];
                                 });
        const double mean = all[1] / all[0];
        return std::max(0., all[2] / all[0] - mean * mean);
      }

    private:
      /** Quadratic splines span three grid cells, so that cells of grid cells
       *  two apart share one. */
      static constexpr unsigned int reach = 2;

      /** Sums of V, V ln det F_g and V (ln det F_g)^2. */
      using Sums = std::array<double, 3>;

      void
      sum(const Cells<dim> &cells)
      {
        // A rank has all cells of its grid cells. So it sums over each of them,
        // and sends the sums to the ranks with grid cells that share splines
        // with it.
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
            grid.box().for_neighbors(
              one.index, reach, [&](const unsigned int, const auto &other) {
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

      const BackgroundGrid<dim>             &grid;
      bool                                   exists_;
      std::unordered_map<unsigned int, Sums> sums;
    };

  } // namespace


  template <int dim>
  void
  spread_uneven_growth(Tissue<dim> &tissue, const double dt)
  {
    const UnevenGrowth<dim> growth(tissue);
    if (!growth.exists())
      return;
    std::vector<double> parts;
    for (unsigned int p = 0; p < tissue.cells().size(); ++p)
      parts.push_back(
        std::min(1.,
                 growth.variance(tissue.cells().position(p)) / fully_uneven));
    spread_cells(tissue, dt, parts);
  }


  MORULA_INSTANTIATE(spread_uneven_growth);
} // namespace Morula
