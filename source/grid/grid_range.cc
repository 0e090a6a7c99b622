// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/grid_range.h>

#include <algorithm>
#include <limits>

namespace Morula
{
  namespace
  {
    /** Whoever looks for a grid cell looks into each range. Where there would
     *  be more, wider gaps are closed, which covers more grid cells but never
     *  misses one. */
    constexpr std::size_t most_ranges = 32;

    /** Adds a range to others that are more than @p gap apart, and unites what
     *  no longer is. */
    template <int dim>
    void
    add(std::vector<GridRange<dim>> &apart, GridRange<dim> range, const int gap)
    {
      // A range that is united with near ones may come near to further ones. So
      // the search begins again until nothing is near.
      while (true)
        {
          const auto near = std::partition(apart.begin(),
                                           apart.end(),
                                           [&](const GridRange<dim> &other) {
                                             return range.gap(other) > gap;
                                           });
          if (near == apart.end())
            // The list is a set: the order does not matter before separated()
            // sorts it.
            break;
          for (auto other = near; other != apart.end(); ++other)
            range.unite(*other);
          apart.erase(near, apart.end());
        }
      apart.push_back(range);
    }
  } // namespace


  template <int dim>
  bool
  GridRange<dim>::empty() const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (first[d] > last[d])
        return true;
    return false;
  }


  template <int dim>
  bool
  GridRange<dim>::contains(const GridIndex<dim> &index) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (index[d] < first[d] || index[d] > last[d])
        return false;
    return true;
  }


  template <int dim>
  void
  GridRange<dim>::unite(const GridRange &other)
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        first[d] = std::min(first[d], other.first[d]);
        last[d]  = std::max(last[d], other.last[d]);
      }
  }


  template <int dim>
  GridRange<dim>
  GridRange<dim>::grown(const int rings, const GridBox<dim> &box) const
  {
    GridRange range;
    for (unsigned int d = 0; d < dim; ++d)
      {
        range.first[d] = std::max(first[d] - rings, box.first()[d]);
        range.last[d] =
          std::min(last[d] + rings, box.first()[d] + box.n()[d] - 1);
      }
    return range;
  }


  template <int dim>
  int
  GridRange<dim>::gap(const GridRange &other) const
  {
    // The largest distance of any direction: two boxes touch only if they touch
    // in all of them.
    int largest = std::numeric_limits<int>::lowest();
    for (unsigned int d = 0; d < dim; ++d)
      largest = std::max(
        {largest, first[d] - other.last[d] - 1, other.first[d] - last[d] - 1});
    return largest;
  }


  template <int dim>
  std::vector<GridRange<dim>>
  separated(const std::vector<GridRange<dim>> &ranges, int gap)
  {
    // Each range is added on its own. Whenever there are too many, the allowed
    // gap doubles and those that are nearer share one: so no list of boxes gets
    // long, however scattered the tissue is.
    std::vector<GridRange<dim>> apart;
    for (const GridRange<dim> &range : ranges)
      if (!range.empty())
        {
          add(apart, range, gap);
          while (apart.size() > most_ranges)
            {
              gap = 2 * gap + 1;
              std::vector<GridRange<dim>> wider;
              for (const GridRange<dim> &one : apart)
                add(wider, one, gap);
              apart = std::move(wider);
            }
        }
    // The order must not depend on that of the input.
    std::sort(apart.begin(), apart.end(), [](const auto &a, const auto &b) {
      return a.first < b.first;
    });
    return apart;
  }


  MORULA_INSTANTIATE(separated);
  template struct GridRange<2>;
  template struct GridRange<3>;
} // namespace Morula
