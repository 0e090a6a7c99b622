// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/filling.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace Morula
{
  namespace bgi = boost::geometry::index;

  template <int dim>
  AllCells<dim>::AllCells(const std::vector<Point<dim>> &positions,
                          const std::vector<double>     &volumes,
                          const double                   length)
    : positions(positions)
    , volumes(volumes)
    , volume(std::accumulate(volumes.begin(), volumes.end(), 0.))
    , length(length > 0.     ? length :
             volumes.empty() ? 0. :
                               std::pow(volume / volumes.size(), 1. / dim))
  {}

  template <int dim>
  Filling<dim>::Filling(const AllCells<dim> &cells)
    : cells(cells)
    , sigma(0.6 * cells.length)
    , tree(pack_rtree_of_indices(cells.positions))
  {}

  template <int dim>
  std::pair<double, Tensor<1, dim>>
  Filling<dim>::value_and_gradient(const Point<dim> &x) const
  {
    // This is doc/theory.md (1.9). Beyond four widths a cell adds less than a
    // thousandth of what it adds at its place.
    const double                      reach = 4. * sigma;
    std::pair<Point<dim>, Point<dim>> corners(x, x);
    for (unsigned int d = 0; d < dim; ++d)
      {
        corners.first[d] -= reach;
        corners.second[d] += reach;
      }
    std::vector<std::size_t> near;
    tree.query(bgi::intersects(BoundingBox<dim>(corners)),
               std::back_inserter(near));
    // The sum is in the order of the cells, so that it does not depend on the
    // tree.
    std::sort(near.begin(), near.end());
    const double scale = std::pow(2. * numbers::PI * sigma * sigma, -0.5 * dim);
    std::pair<double, Tensor<1, dim>> result;
    for (const std::size_t i : near)
      {
        const Tensor<1, dim> way = x - cells.positions[i];
        const double         part =
          scale * cells.volumes[i] *
          std::exp(-0.5 * way.norm_square() / (sigma * sigma));
        result.first += part;
        result.second -= part / (sigma * sigma) * way;
      }
    return result;
  }

  template <int dim>
  double
  Filling<dim>::inside() const
  {
    // The quartile over a thousand cells is near that over all.
    constexpr std::size_t most = 1000;
    const std::size_t     every =
      std::max<std::size_t>(1, cells.positions.size() / most);
    std::vector<double> values;
    for (std::size_t i = 0; i < cells.positions.size(); i += every)
      values.push_back(value_and_gradient(cells.positions[i]).first);
    // Most cells are inside, and those at the surface are below them: so the
    // upper quartile is a value of the inside.
    const auto quartile = values.begin() + values.size() * 3 / 4;
    std::nth_element(values.begin(), quartile, values.end());
    return *quartile;
  }

  template struct AllCells<2>;
  template struct AllCells<3>;
  template class Filling<2>;
  template class Filling<3>;
} // namespace Morula
