// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/filling.h>

#include <deal.II/base/numbers.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <vector>

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


  namespace
  {
    /** Distance of the samples, in lengths of a cell. */
    constexpr double fineness        = 0.5;
    constexpr int    samples_of_cell = 2; // 1 / fineness

    /** Farther from all centres than this, in lengths of a cell, there is room
     *  for one more: between cells side by side the farthest place is 0.87
     *  away, between scattered ones somewhat more. */
    constexpr double roomy = 1.25;

    template <int dim>
    using Sample = std::array<int, dim>;

    /** Calls f(sample) for all neighbours of a sample up to @p reach. */
    template <int dim, typename Function>
    void
    for_around(const Sample<dim> &sample, const int reach, const Function &f)
    {
      const int n   = 2 * reach + 1;
      int       all = 1;
      for (int d = 0; d < dim; ++d)
        all *= n;
      for (int k = 0; k < all; ++k)
        {
          Sample<dim> other = sample;
          for (int d = 0, rest = k; d < dim; ++d, rest /= n)
            other[d] += rest % n - reach;
          f(other);
        }
    }

    /** Calls f(sample) for cubes of a cell's size without a cell: those beside
     *  cubes that hold one, and from there on all around cubes inside. */
    template <int dim, typename Inside, typename Function>
    void
    for_empty_cubes(const AllCells<dim> &cells,
                    const Inside        &is_inside,
                    const Function      &f)
    {
      const double             size = fineness * cells.length * samples_of_cell;
      std::set<Sample<dim>>    full, seen;
      std::vector<Sample<dim>> open;
      for (const Point<dim> &X : cells.positions)
        {
          Sample<dim> sample;
          for (unsigned int d = 0; d < dim; ++d)
            sample[d] =
              samples_of_cell * static_cast<int>(std::lround(X[d] / size));
          full.insert(sample);
        }
      const auto add_around = [&](const Sample<dim> &sample) {
        for_around<dim>(sample, 1, [&](Sample<dim> step) {
          for (int d = 0; d < dim; ++d)
            step[d] = sample[d] + samples_of_cell * (step[d] - sample[d]);
          if (full.count(step) == 0 && seen.insert(step).second)
            open.push_back(step);
        });
      };
      for (const Sample<dim> &sample : full)
        add_around(sample);
      while (!open.empty())
        {
          const Sample<dim> coarse = open.back();
          open.pop_back();
          if (is_inside(coarse))
            add_around(coarse);
          f(coarse);
        }
    }
  } // namespace


  template <int dim>
  double
  room_without_cells(const AllCells<dim>       &cells,
                     const SurfacePatches<dim> &patches)
  {
    // The samples around all cells, up to three lengths away, are a lattice.
    // Those with room for one more cell that lie behind the nearest patch are
    // seeds of gaps. The volume of a gap is that of the samples around its
    // seeds which are inside and where the cells fill less than half: there
    // the surface would stand if it went around the gap.
    namespace bgi = boost::geometry::index;
    if (cells.positions.empty() || patches.positions.empty())
      return 0.;
    const double h        = fineness * cells.length;
    const auto   centers  = pack_rtree(cells.positions);
    const auto   on_patch = pack_rtree_of_indices(patches.positions);
    const auto   place    = [h](const Sample<dim> &sample) {
      Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = h * sample[d];
      return x;
    };
    const auto is_inside = [&](const Point<dim> &x) {
      std::vector<std::size_t> nearest;
      on_patch.query(bgi::nearest(x, 1), std::back_inserter(nearest));
      const std::size_t i = nearest.front();
      return (x - patches.positions[i]) * patches.normals[i] < 0.;
    };
    const auto is_roomy = [&](const Point<dim> &x) {
      std::vector<Point<dim>> nearest;
      centers.query(bgi::nearest(x, 1), std::back_inserter(nearest));
      return x.distance(nearest.front()) > roomy * cells.length;
    };

    std::set<Sample<dim>> gap;
    for_empty_cubes<dim>(
      cells,
      [&](const Sample<dim> &sample) { return is_inside(place(sample)); },
      [&](const Sample<dim> &coarse) {
        for_around<dim>(coarse, 1, [&](const Sample<dim> &sample) {
          const Point<dim> x = place(sample);
          if (gap.count(sample) == 0 && is_roomy(x) && is_inside(x))
            gap.insert(sample);
        });
      });
    if (gap.empty())
      return 0.;
    const Filling<dim>    filling(cells);
    const double          half = 0.5 * filling.inside();
    std::set<Sample<dim>> tried;
    double                volume = 0.;
    for (const Sample<dim> &seed : gap)
      for_around<dim>(seed, samples_of_cell, [&](const Sample<dim> &sample) {
        if (!tried.insert(sample).second)
          return;
        const Point<dim> x = place(sample);
        if (filling.value_and_gradient(x).first < half && is_inside(x))
          volume += std::pow(h, dim);
      });
    return volume;
  }


  MORULA_INSTANTIATE(room_without_cells);
} // namespace Morula
