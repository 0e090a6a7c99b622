// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/shapes/sphere.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  template <int dim>
  Sphere<dim>::Sphere(const Point<dim> &center, const double radius)
    : center(center)
    , radius(radius)
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
    return x.distance(center) < radius - clearance;
  }

  template <int dim>
  double
  Sphere<dim>::volume() const
  {
    return surface_area() * radius / dim;
  }

  template <int dim>
  double
  Sphere<dim>::surface_area() const
  {
    return dim == 3 ? 4. * numbers::PI * radius * radius :
                      2. * numbers::PI * radius;
  }

  template <int dim>
  SurfaceTiling<dim>
  Sphere<dim>::tile(const std::uint64_t n_wished) const
  {
    SurfaceTiling<dim> tiling;
    tiling.n_patches = std::max<std::uint64_t>(n_wished, dim + 1);

    const double n    = static_cast<double>(tiling.n_patches);
    const double area = surface_area() / n;
    tiling.patch      = [sphere = *this, n, area](const std::uint64_t i) {
      SurfacePatch<dim> patch;
      patch.area         = area;
      const double index = static_cast<double>(i);
      if constexpr (dim == 3)
        {
          const double z        = 1. - (2. * index + 1.) / n;
          const double parallel = std::sqrt((1. - z) * (1. + z));
          const double angle    = 2. * numbers::PI * golden_fraction(i);
          patch.normal[0]       = parallel * std::cos(angle);
          patch.normal[1]       = parallel * std::sin(angle);
          patch.normal[2]       = z;
        }
      else
        {
          const double angle = 2. * numbers::PI * ((index + 0.5) / n);
          patch.normal[0]    = std::cos(angle);
          patch.normal[1]    = std::sin(angle);
        }
      patch.position = sphere.center + sphere.radius * patch.normal;
      return patch;
    };
    return tiling;
  }

  template class Sphere<2>;
  template class Sphere<3>;
} // namespace Morula
