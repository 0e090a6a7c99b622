// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/state/surface_distance.h>

#include <deal.II/base/mpi.h>
#include <deal.II/boost_adaptors/point.h>

#include <boost/geometry/index/rtree.hpp>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace Morula
{
  template <int dim>
  std::vector<NearSurface<dim>>
  near_surface(const std::vector<Point<dim>>     &places,
               const std::vector<Point<dim>>     &points,
               const std::vector<Tensor<1, dim>> &normals,
               const MPI_Comm                     comm)
  {
    namespace bgi = boost::geometry::index;
    using Patches =
      std::pair<std::vector<Point<dim>>, std::vector<Tensor<1, dim>>>;
    using Entry = std::pair<Point<dim>, std::size_t>;

    Patches all;
    for (const Patches &part :
         Utilities::MPI::all_gather(comm, Patches(points, normals)))
      {
        all.first.insert(all.first.end(), part.first.begin(), part.first.end());
        all.second.insert(all.second.end(),
                          part.second.begin(),
                          part.second.end());
      }
    std::vector<Entry> entries;
    for (std::size_t i = 0; i < all.first.size(); ++i)
      entries.emplace_back(all.first[i], i);
    const bgi::rtree<Entry, bgi::linear<16>> tree(entries);

    std::vector<NearSurface<dim>> result(places.size());
    for (std::size_t k = 0; k < places.size(); ++k)
      {
        std::vector<Entry> nearest;
        tree.query(bgi::nearest(places[k], 1), std::back_inserter(nearest));
        if (nearest.empty())
          {
            result[k].depth = std::numeric_limits<double>::infinity();
            continue;
          }
        result[k].normal = all.second[nearest[0].second];
        result[k].depth =
          std::max(0., (nearest[0].first - places[k]) * result[k].normal);
      }
    return result;
  }

#define INSTANTIATE(dim)                               \
  template std::vector<NearSurface<dim>> near_surface( \
    const std::vector<Point<dim>> &,                   \
    const std::vector<Point<dim>> &,                   \
    const std::vector<Tensor<1, dim>> &,               \
    const MPI_Comm);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
