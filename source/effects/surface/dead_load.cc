// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/dead_load.h>

#include <utility>

namespace Morula
{
  template <int dim>
  DeadLoad<dim>::DeadLoad(GroupedPoints<dim>          points,
                          std::vector<Tensor<1, dim>> forces)
    : PointTerm<dim>(std::move(points))
    , forces(std::move(forces))
  {}


  template <int dim>
  void
  DeadLoad<dim>::add(const unsigned int     grid_cell,
                     const LocalField<dim> &field,
                     const GrowthAt         growth,
                     LocalSystem<dim>      &system) const
  {
    // A force that does not depend on u has no tangent.
    if (system.wanted != LocalSystem<dim>::tangent)
      PointTerm<dim>::add(grid_cell, field, growth, system);
  }


  template <int dim>
  void
  DeadLoad<dim>::add_point(const unsigned int       p,
                           const SplineValues<dim> &splines,
                           const LocalField<dim>   &field,
                           LocalSystem<dim>        &system) const
  {
    // This is the force of doc/theory.md (4.7).
    system.add_energy(-(forces[p] * field.value(splines)));
    add_force_at(splines, -forces[p], system);
  }


  template class DeadLoad<2>;
  template class DeadLoad<3>;
} // namespace Morula
