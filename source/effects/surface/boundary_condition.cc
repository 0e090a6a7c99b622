// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/part_of_step.h>
#include <morula/effects/surface/boundary_condition.h>

#include <utility>

namespace Morula
{
  template <int dim>
  Tensor<1, dim>
  BoundaryCondition<dim>::displacement(const Point<dim> &, const double) const
  {
    return Tensor<1, dim>();
  }


  template <int dim>
  std::vector<typename BoundaryCondition<dim>::Part>
  BoundaryCondition<dim>::parts(const LoadedPoints<dim> &points,
                                const double             t) const
  {
    std::vector<Part> list;
    if (auto whole = term(points, t))
      list.push_back({"", std::move(whole)});
    return list;
  }


  // Here, as a null pointer to an unknown class could not be deleted.
  template <int dim>
  std::unique_ptr<PartOfStep<dim>>
  BoundaryCondition<dim>::part_of_step(const AttemptAtStep<dim> &) const
  {
    return nullptr;
  }


  template <int dim>
  bool
  BoundaryCondition<dim>::moves() const
  {
    // A load moves tissue from rest; what holds points does so only if it is
    // prescribed to move.
    return kind() == SurfaceCondition::loaded;
  }


  template class BoundaryCondition<2>;
  template class BoundaryCondition<3>;
} // namespace Morula
