// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/grid_box.h>
#include <morula/particles/surroundings.h>

#include <algorithm>

namespace Morula
{
  namespace
  {
    /** Distance from which on cells do not count, in grid spacings. */
    constexpr double reach = 0.75;

    /** Added to the variance of the positions, which is about 0.05 in units of
     *  the squared reach: cells that are all about equally far from the surface
     *  say nothing of a slope. */
    constexpr double least_variance = 1e-3;

    /** Changes weights that fall off with the distance so that they reproduce
     *  linear functions: doc/theory.md (4.6c). @param s ways from the place to
     *  the cells, in units of the reach */
    template <int dim>
    void
    make_linear(const std::vector<Tensor<1, dim>> &s, std::vector<double> &w)
    {
      // The weights w get a factor that is linear in s, such that Σ ω s = 0:
      // with it the value at the place is that of the plane through the cells'
      // values.
      double         sum = 0.;
      Tensor<1, dim> mean;
      for (std::size_t i = 0; i < s.size(); ++i)
        {
          sum += w[i];
          mean += w[i] * s[i];
        }
      mean /= sum;
      SymmetricTensor<2, dim> variance =
        least_variance * unit_symmetric_tensor<dim>();
      for (std::size_t i = 0; i < s.size(); ++i)
        variance +=
          w[i] / sum * symmetrize(outer_product(s[i] - mean, s[i] - mean));
      const Tensor<1, dim> slope = invert(variance) * mean;
      for (std::size_t i = 0; i < s.size(); ++i)
        w[i] *= (1. - slope * (s[i] - mean)) / sum;
    }
  } // namespace


  template <int dim>
  Surroundings<dim>::Surroundings(const std::vector<Point<dim>> &places,
                                  const Tissue<dim>             &tissue,
                                  const std::vector<Side<dim>>  &sides)
    : places(places)
    , cells(tissue.cells())
    , grid(tissue.grid())
  {
    // Cells within reach are at most in the neighbouring grid cells, of this or
    // another rank; they come with their volumes. Bins find those around
    // each place. Their weights fall to zero at the reach, so that no cell
    // enters or leaves with a jump, and are made linear after that,
    // doc/theory.md (4.6c). A place without cells keeps an empty list.
    const double radius = reach * grid.box().spacing();
    const auto   volume = [&](const unsigned int p, std::vector<double> &list) {
      list.push_back(cells[p].volume());
      list.push_back(cells.body(p));
    };
    const PointList<dim> near =
      near_points(places, cells, {2, volume, Ties::lowest_id}, grid, 1);
    const PointBins<dim> bins(grid.box(), near.positions);
    for (std::size_t place = 0; place < places.size(); ++place)
      {
        const Point<dim>        &x = places[place];
        std::vector<std::size_t> found;
        // Rounding must not leave out a cell that has a weight.
        bins.visit_within(x, radius * (1. + 1e-9), [&](const auto i) {
          found.push_back(i);
        });
        // They are taken by id, so that sums do not depend on the ranks.
        std::sort(found.begin(), found.end(), [&](const auto i, const auto j) {
          return near.ids[i] < near.ids[j];
        });

        std::vector<std::size_t>    around;
        std::vector<Tensor<1, dim>> ways;
        std::vector<double>         weights;
        for (const std::size_t i : found)
          {
            const Tensor<1, dim> s    = (near.positions[i] - x) / radius;
            const double         fall = 1. - s.norm_square();
            if (fall <= 0. ||
                (!sides.empty() && (near.row(i)[1] != sides[place].body ||
                                    !sides[place].has(x, near.positions[i]))))
              continue;
            around.push_back(i);
            ways.push_back(s);
            weights.push_back(fall * fall * near.row(i)[0]);
          }
        if (!around.empty())
          make_linear(ways, weights);
        shares.emplace_back();
        for (std::size_t k = 0; k < around.size(); ++k)
          shares.back().emplace_back(around[k], weights[k]);
      }
  }

  template class Surroundings<2>;
  template class Surroundings<3>;
} // namespace Morula
