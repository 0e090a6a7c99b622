// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_scene_loads_at_start_h
#define morula_scene_loads_at_start_h

#include <morula/effects/surface/boundary_conditions.h>
#include <morula/scene/scene.h>
#include <morula/seeding/seeding.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace Morula
{
  /** The boundary points of this rank that conditions load at t = 0, and the
   *  forces of conditions on them before there is a grid. */
  template <int dim>
  class LoadsAtStart
  {
  public:
    LoadsAtStart(const Scene                   &scene,
                 const BoundaryConditions<dim> &conditions,
                 const SurfacePatches<dim>     &surface);

    /** The points, in the order of patches. */
    const LoadedPoints<dim> &
    points() const;

    /** The number of a point in the patches of this rank. */
    std::size_t
    patch(const std::size_t point) const
    {
      return numbers[point];
    }

    /**
     * The forces of a condition on points() at @p t (day) on the surface of t
     * = 0, kPa µm^(dim-1); none if they are not known before the run.
     * @throws InputError for expressions without a value
     */
    std::optional<std::vector<Tensor<1, dim>>>
    forces(const BoundaryCondition<dim> &condition, const double t) const;

  private:
    LoadedPoints<dim>        loaded;
    std::vector<std::size_t> numbers;
  };
} // namespace Morula

#endif
