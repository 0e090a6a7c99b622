// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/scene/loads_at_start.h>

namespace Morula
{
  template <int dim>
  LoadsAtStart<dim>::LoadsAtStart(const Scene                   &scene,
                                  const BoundaryConditions<dim> &conditions,
                                  const SurfacePatches<dim>     &surface)
  {
    // There is no grid yet, so all points are put into one grid cell: its
    // splines add up to 1 at any place, and so the force on each point is
    // right. Nothing has moved, so that the present position and area are the
    // initial ones.
    for (std::size_t i = 0; i < surface.positions.size(); ++i)
      {
        const Point<dim>     &X = surface.positions[i];
        const Tensor<1, dim> &N = surface.normals[i];
        if (conditions.condition(X, N) != SurfaceCondition::loaded)
          continue;
        const double a = surface.areas[i];
        loaded.points.push_back({X, X, N, X, a, a * N});
        numbers.push_back(i);
      }
    const unsigned int n = loaded.points.size();
    loaded.offsets       = {0, n};
    Point<dim> middle;
    for (unsigned int d = 0; d < dim; ++d)
      middle[d] = 0.5;
    loaded.xi.assign(n, middle);
    loaded.h = scene.grid.spacing;
  }


  template <int dim>
  const LoadedPoints<dim> &
  LoadsAtStart<dim>::points() const
  {
    return loaded;
  }


  template <int dim>
  std::optional<std::vector<Tensor<1, dim>>>
  LoadsAtStart<dim>::forces(const BoundaryCondition<dim> &condition,
                            const double                  t) const
  {
    std::optional<std::vector<Tensor<1, dim>>> result;
    if (condition.only_pushes() || condition.kind() != SurfaceCondition::loaded)
      return result;
    for (const auto &part : condition.parts(loaded, t))
      {
        if (!result)
          result.emplace(loaded.points.size());
        const auto list = part.term->forces(0, LocalField<dim>{});
        for (std::size_t l = 0; l < list.size(); ++l)
          (*result)[l] += list[l];
      }
    return result;
  }


  template class LoadsAtStart<2>;
  template class LoadsAtStart<3>;
} // namespace Morula
