// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_base_near_tree_h
#define morula_base_near_tree_h

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>
#include <deal.II/boost_adaptors/bounding_box.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Finds the positions around a place, by deal.II's R-tree. Keeps a reference
   *  to the positions. */
  template <int dim>
  class NearTree
  {
  public:
    /** @param positions µm */
    explicit NearTree(const std::vector<Point<dim>> &positions)
      : positions(positions)
      , tree(pack_rtree_of_indices(positions))
    {}

    /** The numbers of the positions at most @p radius (µm) from @p x, in
     *  increasing order. */
    std::vector<unsigned int>
    within(const Point<dim> &x, const double radius) const
    {
      Point<dim> lower = x, upper = x;
      for (unsigned int d = 0; d < dim; ++d)
        {
          lower[d] -= radius;
          upper[d] += radius;
        }
      std::vector<unsigned int> found;
      tree.query(boost::geometry::index::intersects(
                   BoundingBox<dim>({lower, upper})),
                 std::back_inserter(found));
      found.erase(std::remove_if(found.begin(),
                                 found.end(),
                                 [&](const unsigned int i) {
                                   return x.distance(positions[i]) > radius;
                                 }),
                  found.end());
      std::sort(found.begin(), found.end());
      return found;
    }

    /** The number of the position nearest to @p x. There must be one. */
    unsigned int
    nearest(const Point<dim> &x) const
    {
      std::vector<unsigned int> found;
      tree.query(boost::geometry::index::nearest(x, 1),
                 std::back_inserter(found));
      return found.at(0);
    }

    /** The lowest number of the positions nearest to @p x of those that
     *  @p counts(number); nothing if there is none. */
    template <typename Counts>
    std::optional<unsigned int>
    nearest(const Point<dim> &x, const Counts &counts) const
    {
      std::vector<unsigned int> found;
      tree.query(boost::geometry::index::nearest(x, 1) &&
                   boost::geometry::index::satisfies(counts),
                 std::back_inserter(found));
      if (found.empty())
        return {};
      for (const unsigned int i :
           within(x, x.distance(positions[found[0]]) * (1. + 1e-9)))
        if (counts(i))
          return i;
      return found[0];
    }

  private:
    const std::vector<Point<dim>>                      &positions;
    const decltype(pack_rtree_of_indices(
      std::declval<const std::vector<Point<dim>> &>())) tree;
  };
} // namespace Morula

#endif
