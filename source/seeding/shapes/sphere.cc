// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/shapes/sphere.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    template <int dim>
    double
    area_of(const double radius)
    {
      return dim == 3 ? 4. * numbers::PI * radius * radius :
                        2. * numbers::PI * radius;
    }

    /** The outward normal of patch @p i of @p n. */
    template <int dim>
    Tensor<1, dim>
    direction(const std::uint64_t i, const std::uint64_t n)
    {
      Tensor<1, dim> normal;
      const double   index = static_cast<double>(i);
      if constexpr (dim == 3)
        {
          // The points are those of a golden spiral: heights share the area
          // equally, and each point is a golden angle behind the last.
          const double z        = 1. - (2. * index + 1.) / n;
          const double parallel = std::sqrt((1. - z) * (1. + z));
          const double angle    = 2. * numbers::PI * golden_fraction(i);
          normal[0]             = parallel * std::cos(angle);
          normal[1]             = parallel * std::sin(angle);
          normal[2]             = z;
        }
      else
        {
          const double angle = 2. * numbers::PI * ((index + 0.5) / n);
          normal[0]          = std::cos(angle);
          normal[1]          = std::sin(angle);
        }
      return normal;
    }
  } // namespace

  template <int dim>
  Sphere<dim>::Sphere(const Point<dim> &center,
                      const double      radius,
                      const double      inner_radius)
    : center(center)
    , radius(radius)
    , inner_radius(inner_radius)
  {}

  template <int dim>
  BoundingBox<dim>
  Sphere<dim>::bounding_box() const
  {
    BoundingBox<dim> box({center, center});
    box.extend(radius);
    return box;
  }

  template <int dim>
  bool
  Sphere<dim>::contains(const Point<dim> &x, const double clearance) const
  {
    const double r = x.distance(center);
    return r < radius - clearance &&
           (inner_radius == 0. || r > inner_radius + clearance);
  }

  template <int dim>
  double
  Sphere<dim>::volume() const
  {
    return (area_of<dim>(radius) * radius -
            area_of<dim>(inner_radius) * inner_radius) /
           dim;
  }

  template <int dim>
  double
  Sphere<dim>::surface_area() const
  {
    return area_of<dim>(radius) + area_of<dim>(inner_radius);
  }

  template <int dim>
  SurfaceTiling<dim>
  Sphere<dim>::tile(const std::uint64_t n_wished) const
  {
    const double outer = area_of<dim>(radius);
    const double inner = area_of<dim>(inner_radius);
    // Both surfaces share the number by their areas, at least dim + 1 patches
    // each: fewer enclose nothing. Without a cavity there are just as many as
    // wished. The normals of the inner one point into the cavity, out of the
    // tissue.
    const std::uint64_t n_inner =
      inner > 0. ? std::max<std::uint64_t>(std::llround(n_wished * inner /
                                                        (outer + inner)),
                                           dim + 1) :
                   0;
    const std::uint64_t n_outer =
      std::max<std::uint64_t>(n_wished - std::min(n_wished, n_inner), dim + 1);

    SurfaceTiling<dim> tiling;
    tiling.n_patches = n_outer + n_inner;
    tiling.patch =
      [sphere = *this, n_outer, n_inner, outer, inner](const std::uint64_t i) {
        SurfacePatch<dim> patch;
        if (i < n_outer)
          {
            patch.area     = outer / n_outer;
            patch.normal   = direction<dim>(i, n_outer);
            patch.position = sphere.center + sphere.radius * patch.normal;
          }
        else
          {
            patch.area     = inner / n_inner;
            patch.normal   = -direction<dim>(i - n_outer, n_inner);
            patch.position = sphere.center - sphere.inner_radius * patch.normal;
          }
        return patch;
      };
    return tiling;
  }

  template class Sphere<2>;
  template class Sphere<3>;
} // namespace Morula
