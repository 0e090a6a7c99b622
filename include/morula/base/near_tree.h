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

  private:
    const std::vector<Point<dim>>                      &positions;
    const decltype(pack_rtree_of_indices(
      std::declval<const std::vector<Point<dim>> &>())) tree;
  };
} // namespace Morula

#endif
