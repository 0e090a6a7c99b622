// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/obstacles/body.h>
#include <morula/effects/obstacles/obstacle_parameters.h>
#include <morula/scene/far_obstacles.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>

namespace Morula
{
  namespace
  {
    /** The longest extent of the surface along an axis, µm. Collective. */
    template <int dim>
    double
    extent_of(const SurfacePatches<dim> &surface, const MPI_Comm comm)
    {
      double extent = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          double lower = std::numeric_limits<double>::max(), upper = -lower;
          for (const Point<dim> &X : surface.positions)
            {
              lower = std::min(lower, X[d]);
              upper = std::max(upper, X[d]);
            }
          extent = std::max(extent,
                            Utilities::MPI::max(upper, comm) -
                              Utilities::MPI::min(lower, comm));
        }
      return extent;
    }

    /** The length of an obstacle's way until the end, µm, by the midpoints of
     *  some times. */
    template <int dim>
    double
    length_of_way(const ObstacleKeys &keys, const double end_time)
    {
      constexpr unsigned int n        = 200;
      const Expression      &velocity = keys.velocity.expression(dim);
      double                 way      = 0.;
      for (unsigned int i = 0; i < n; ++i)
        way += velocity.vector(Point<dim>(), (i + 0.5) / n * end_time).norm() *
               end_time / n;
      return way;
    }
  } // namespace


  template <int dim>
  void
  review_far_obstacles(const Scene               &scene,
                       const SurfacePatches<dim> &surface,
                       const MPI_Comm             comm,
                       Review                    &review)
  {
    // The tissue may come nearer as well, by growth or loads; beyond its own
    // length that was hardly meant. All ranks go through the same list.
    const ObstaclesParameters &parameters = scene.keys<ObstaclesParameters>();
    if (!parameters.is_on() || surface.n_global == 0)
      return;
    const double extent = extent_of(surface, comm);
    for (const ObstacleKeys &keys : parameters.obstacles)
      {
        const auto body    = make_body<dim>(keys);
        double     nearest = std::numeric_limits<double>::max();
        for (const Point<dim> &X : surface.positions)
          {
            const double outside = body->distance(X).value;
            nearest =
              std::min(nearest, keys.side == "inside" ? -outside : outside);
          }
        nearest          = Utilities::MPI::min(nearest, comm);
        const double way = length_of_way<dim>(keys, scene.time.end_time);
        if (nearest > way + extent)
          review.warn(parameters.names_key()->path(),
                      keys.name,
                      "it stands " + as_text(nearest) +
                        " um from the tissue, which is " + as_text(extent) +
                        " um long, and moves by " + as_text(way) +
                        " um until the end: they do not meet unless the "
                        "tissue grows or moves that far. Are its lengths in "
                        "um and its Velocity in um/day?",
                      "If it is meant so, all is well.");
      }
  }


#define INSTANTIATE(dim)                                          \
  template void review_far_obstacles(const Scene &,               \
                                     const SurfacePatches<dim> &, \
                                     const MPI_Comm,              \
                                     Review &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
