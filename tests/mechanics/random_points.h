// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_mechanics_random_points_h
#define morula_tests_mechanics_random_points_h

#include "common/finite_differences.h"
#include "common/materials.h"
#include "common/pools.h"

namespace Morula
{
  const std::vector<VolumetricStrain> all_forms = {VolumetricStrain::pointwise,
                                                   VolumetricStrain::pooled};

  template <int dim>
  MaterialPoints<dim>
  random_material_points(std::mt19937      &generator,
                         const unsigned int n,
                         const bool         growing,
                         const bool         uniform,
                         const Material    &material = neo_hookean())
  {
    MaterialPoints<dim> points;
    points.material = &material;
    static_cast<GroupedPoints<dim> &>(points) =
      random_points_in_cell<dim>(generator, n);
    for (unsigned int p = 0; p < (uniform ? 1 : n); ++p)
      points.lame.push_back(lame(1. + p, 0.3 + 0.1 * (p % 2)));
    points.current = random_states<dim>(generator, n);
    if (growing)
      points.previous = random_states<dim>(generator, n);
    if (uniform)
      pool(points);
    else
      pool_in_groups(points);
    return points;
  }

  /** The points with other deformations and volumes. */
  template <int dim>
  MaterialPoints<dim>
  stretched_by(const double stretch, MaterialPoints<dim> points)
  {
    for (auto *states : {&points.current, &points.previous})
      for (auto &state : *states)
        state.A *= stretch;
    for (double &c : points.carried)
      c *= std::pow(stretch, dim);
    return points;
  }
} // namespace Morula

#endif
