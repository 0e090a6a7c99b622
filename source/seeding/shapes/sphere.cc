// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <memory>

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

    /** A ball; in 2-D, a disc. It may have a concentric cavity. */
    template <int dim>
    class Sphere : public Shape<dim>
    {
    public:
      /** @param radius µm
       *  @param inner_radius of the cavity, µm; 0: there is none */
      Sphere(const Point<dim> &center,
             const double      radius,
             const double      inner_radius = 0.)
        : center(center)
        , radius(radius)
        , inner_radius(inner_radius)
      {}

      BoundingBox<dim>
      bounding_box() const override
      {
        BoundingBox<dim> box({center, center});
        box.extend(radius);
        return box;
      }

      bool
      contains(const Point<dim> &x, const double clearance) const override
      {
        const double r = x.distance(center);
        return r < radius - clearance &&
               (inner_radius == 0. || r > inner_radius + clearance);
      }

      double
      volume() const override
      {
        return (area_of<dim>(radius) * radius -
                area_of<dim>(inner_radius) * inner_radius) /
               dim;
      }

      double
      surface_area() const override
      {
        return area_of<dim>(radius) + area_of<dim>(inner_radius);
      }

      /**
       * In 3-D, a golden spiral from the top to the bottom,
       * z_i = R (1 - (2i+1)/n); in 2-D, the middles of equal arcs. All patches
       * have equal areas; there are at least dim + 1 of them. Those of a cavity
       * follow in the same way, about as large.
       */
      SurfaceTiling<dim>
      tile(const std::uint64_t n_wished) const override
      {
        const double outer = area_of<dim>(radius);
        const double inner = area_of<dim>(inner_radius);
        // Both surfaces share the number by their areas, at least dim + 1
        // patches each: fewer enclose nothing. Without a cavity there are just
        // as many as wished. The normals of the inner one point into the
        // cavity, out of the tissue.
        const std::uint64_t n_inner =
          inner > 0. ? std::max<std::uint64_t>(std::llround(n_wished * inner /
                                                            (outer + inner)),
                                               dim + 1) :
                       0;
        const std::uint64_t n_outer =
          std::max<std::uint64_t>(n_wished - std::min(n_wished, n_inner),
                                  dim + 1);

        SurfaceTiling<dim> tiling;
        tiling.n_patches = n_outer + n_inner;
        tiling.patch     = [sphere = *this, n_outer, n_inner, outer, inner](
                         const std::uint64_t i) {
          SurfacePatch<dim> patch;
          if (i < n_outer)
            {
              patch.area     = outer / n_outer;
              patch.normal   = direction<dim>(i, n_outer);
              patch.position = sphere.center + sphere.radius * patch.normal;
            }
          else
            {
              patch.area   = inner / n_inner;
              patch.normal = -direction<dim>(i - n_outer, n_inner);
              patch.position =
                sphere.center - sphere.inner_radius * patch.normal;
            }
          return patch;
        };
        return tiling;
      }

    private:
      Point<dim> center;
      double     radius, inner_radius;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<Shape<dim>>
  make_sphere(const TissueParameters &parameters)
  {
    return std::make_unique<Sphere<dim>>(leading_components<dim>(
                                           parameters.center),
                                         parameters.radius,
                                         parameters.inner_radius);
  }


  MORULA_INSTANTIATE(make_sphere);
} // namespace Morula
