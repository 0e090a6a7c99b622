// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_common_pools_h
#define morula_tests_common_pools_h

#include <morula/mechanics/material_points.h>

#include <cmath>

namespace Morula
{
  /** Lets points carry about what their growth at t + dt has, W of an energy
   * per grown volume, and makes one pool of each grid cell. */
  template <int dim>
  void
  pool(MaterialPoints<dim> &points)
  {
    points.carried.clear();
    points.grown.clear();
    points.pools = {};
    for (unsigned int p = 0; p < points.xi.size(); ++p)
      {
        const auto &[A, W] = points.current[p];
        points.carried.push_back(W * std::abs(determinant(A)));
        points.grown.push_back({points.states(GrowthAt::previous)[p].W, W});
      }
    make_pools_of_grid_cells(points);
  }

  /** Makes the points of a grid cell two pools, of which the second one is
   * mixed: two thirds of its points are of one phase, the others of another
   * one. */
  template <int dim>
  void
  pool_in_groups(MaterialPoints<dim> &points)
  {
    pool(points);
    const unsigned int n = points.xi.size();
    if (n < 4)
      return;
    points.pools         = {};
    points.pools.offsets = {0, 2};
    points.pools.list    = {{0, n / 4, 0, 1}, {n / 4, n, 1, 3}};
    points.pools.groups  = {{0, n / 4, 0, {}, {}},
                            {n / 4, 3 * n / 4, 1, {}, {}},
                            {3 * n / 4, n, 2, {}, {}}};
    for (PoolGroup &group : points.pools.groups)
      for (unsigned int p = group.first; p < group.last; ++p)
        {
          const auto  &lame = points.lame_of(p);
          const double k = points.material->bulk_modulus(lame.lambda, lame.mu);
          group.modulus.before += k * points.states(GrowthAt::previous)[p].W;
          group.modulus.after += k * points.current[p].W;
          group.grown.before += points.grown[p].before;
          group.grown.after += points.grown[p].after;
        }
  }
} // namespace Morula

#endif
