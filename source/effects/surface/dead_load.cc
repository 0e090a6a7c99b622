// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/dead_load.h>

namespace Morula
{
  template <int dim>
  DeadLoad<dim>::DeadLoad(GroupedPoints<dim>          points,
                          std::vector<Tensor<1, dim>> forces)
    : points(std::move(points))
    , forces(std::move(forces))
  {}

  template <int dim>
  void
  DeadLoad<dim>::add(const unsigned int     cell,
                     const LocalField<dim> &field,
                     const GrowthAt,
                     LocalSystem<dim> &system) const
  {
    if (system.wanted == LocalSystem<dim>::tangent)
      return;
    for (unsigned int p = points.offsets[cell]; p < points.offsets[cell + 1];
         ++p)
      {
        const SplineValues<dim> splines(points.xi[p], points.h);
        system.add_energy(-(forces[p] * field.value(splines)));
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int a = 0; a < BSpline<dim>::n; ++a)
            system.add_force(i, a, -forces[p][i] * splines.value[a]);
      }
  }

  template class DeadLoad<2>;
  template class DeadLoad<3>;
} // namespace Morula
