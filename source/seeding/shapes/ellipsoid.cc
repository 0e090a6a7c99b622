// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/numbers.h>

#include <boost/math/special_functions/ellint_2.hpp>
#include <boost/math/special_functions/ellint_rg.hpp>
#include <boost/math/tools/roots.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <tuple>

namespace Morula
{
  namespace
  {
    /**
     * The angle up to which the integral of sqrt(1 - k² cos²) from 0 has the
     * @p fraction (in [0,1]) of its value at 2 pi.
     */
    double
    angle_at_fraction(const double k, const double fraction)
    {
      // In psi = angle - pi/2 the integral is Legendre's E(psi, k) + E(k).
      const double wanted = (4. * fraction - 1.) * boost::math::ellint_2(k);
      const auto   error_and_slope = [k, wanted](const double psi) {
        const double s = k * std::sin(psi);
        return std::make_tuple(boost::math::ellint_2(k, psi) - wanted,
                               std::sqrt((1. - s) * (1. + s)));
      };
      // The guess is the answer for k = 0.
      const double guess = (4. * fraction - 1.) * numbers::PI_2;
      return numbers::PI_2 + boost::math::tools::newton_raphson_iterate(
                               error_and_slope,
                               guess,
                               -numbers::PI_2,
                               3. * numbers::PI_2,
                               std::numeric_limits<double>::digits - 4);
    }

    /**
     * Latitudes of an ellipsoid with half axes a >= b of the parallels and c
     * along the pole, by the fraction of the area above them.
     */
    class Latitudes
    {
    public:
      Latitudes(const double a, const double b, const double c)
        : a2(a * a)
        , b2(b * b)
        , c2(c * c)
        , heights(n_bands + 1)
        , fractions(n_bands + 1)
      {
        heights[0] = 1.;
        for (unsigned int band = 0; band < n_bands; ++band)
          {
            heights[band + 1]   = std::cos(numbers::PI * (band + 1) / n_bands);
            const double middle = 0.5 * (heights[band] + heights[band + 1]);
            // The density is proportional to the band's area per height.
            const double density = std::sqrt(steepest(middle)) *
                                   boost::math::ellint_2(modulus(middle));
            fractions[band + 1] =
              fractions[band] + density * (heights[band] - heights[band + 1]);
          }
        const double total = fractions.back();
        for (double &fraction : fractions)
          fraction /= total;
      }

      /** Height over the equator, in units of c, above which the @p fraction of
       *  the area lies. */
      double
      height(const double fraction) const
      {
        // Within a band the area is taken as linear in the height; 4096 bands
        // make that exact enough.
        const auto   above = std::upper_bound(fractions.begin() + 1,
                                            fractions.end() - 1,
                                            fraction);
        const auto   i     = std::distance(fractions.begin(), above);
        const double s =
          (fraction - fractions[i - 1]) / (fractions[i] - fractions[i - 1]);
        return heights[i - 1] + s * (heights[i] - heights[i - 1]);
      }

      /**
       * k of the area's density along the parallel at @p height, which is
       * proportional to sqrt(1 - k² cos²).
       */
      double
      modulus(const double height) const
      {
        const double s2 = (1. - height) * (1. + height);
        return std::sqrt((a2 - b2) * c2 * s2 / steepest(height));
      }

    private:
      /** Square of the largest density on a parallel. */
      double
      steepest(const double height) const
      {
        const double s2 = (1. - height) * (1. + height);
        return a2 * c2 * s2 + a2 * b2 * height * height;
      }

      static constexpr unsigned int n_bands = 4096;

      double              a2, b2, c2;
      std::vector<double> heights;
      std::vector<double> fractions;
    };

    /** An axis-parallel ellipsoid; in 2-D, an ellipse. */
    template <int dim>
    class Ellipsoid : public Shape<dim>
    {
    public:
      /** @param half_axes µm */
      Ellipsoid(const Point<dim> &center, const Tensor<1, dim> &half_axes)
        : center(center)
        , half_axes(half_axes)
      {
        // The axes are put in order, the shortest first.
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(),
                         order.end(),
                         [&](const unsigned int d, const unsigned int e) {
                           return half_axes[d] < half_axes[e];
                         });
        if constexpr (dim == 3)
          {
            const double length[3] = {half_axes[order[0]],
                                      half_axes[order[1]],
                                      half_axes[order[2]]};
            // If length[2]/length[1] < length[1]/length[0], the two longer axes
            // are the more similar ones, and the shortest is the pole.
            if (length[2] * length[0] < length[1] * length[1])
              std::swap(order[0], order[2]);
          }
        // Latitudes need the longer axis of the parallels first.
        if (half_axes[order[0]] < half_axes[order[1]])
          std::swap(order[0], order[1]);
      }

      BoundingBox<dim>
      bounding_box() const override
      {
        return BoundingBox<dim>({center - half_axes, center + half_axes});
      }

      /** Estimates the distance to the surface to first order. */
      bool
      contains(const Point<dim> &x, const double clearance) const override
      {
        // The distance to the surface is about (1 - level) level / |gradient|,
        // to first order in it.
        double         level = 0.; // 0 at the centre, 1 on the surface
        Tensor<1, dim> gradient;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double scaled = (x[d] - center[d]) / half_axes[d];
            level += scaled * scaled;
            gradient[d] = scaled / half_axes[d];
          }
        level = std::sqrt(level);
        if (level == 0.)
          return *std::min_element(&half_axes[0], &half_axes[0] + dim) >
                 clearance;
        return (1. - level) * level > clearance * gradient.norm();
      }

      double
      volume() const override
      {
        double product = dim == 3 ? 4. / 3. * numbers::PI : numbers::PI;
        for (unsigned int d = 0; d < dim; ++d)
          product *= half_axes[d];
        return product;
      }

      /**
       * Exact: 4 pi R_G(a²b², a²c², b²c²) with Carlson's symmetric elliptic
       * integral (DLMF 19.33.1); in 2-D 4 a E(k), k² = 1 - b²/a².
       */
      double
      surface_area() const override
      {
        // The area is Carlson's symmetric integral in 3-D, Legendre's in 2-D.
        const auto square = [](const double x) { return x * x; };
        if constexpr (dim == 3)
          return 4. * numbers::PI *
                 boost::math::ellint_rg(square(half_axes[0] * half_axes[1]),
                                        square(half_axes[0] * half_axes[2]),
                                        square(half_axes[1] * half_axes[2]));
        else
          {
            const double a = half_axes[order[0]];
            const double b = half_axes[order[1]];
            return 4. * a *
                   boost::math::ellint_2(std::sqrt((a - b) * (a + b)) / a);
          }
      }

      /**
       * The sphere's golden spiral, mapped such that areas are preserved: the
       * band above each latitude has the same fraction of the area as on the
       * sphere, and the part of a parallel west of each point the same fraction
       * of the area density along the parallel. In 2-D, the middles of equal
       * arcs. All patches have equal areas; there are at least dim + 1 of them.
       */
      SurfaceTiling<dim>
      tile(const std::uint64_t n_wished) const override;

    private:
      /**
       * The patch around the point center + @p from_center of the surface, with
       * the normal there.
       */
      SurfacePatch<dim>
      patch_at(const Tensor<1, dim> &from_center, const double area) const
      {
        SurfacePatch<dim> patch;
        patch.position = center + from_center;
        for (unsigned int d = 0; d < dim; ++d)
          // The normal is the gradient of the level.
          patch.normal[d] = from_center[d] / half_axes[d] / half_axes[d];
        patch.normal /= patch.normal.norm();
        patch.area = area;
        return patch;
      }

      Point<dim>     center;
      Tensor<1, dim> half_axes;
      /**
       * Coordinate directions: first the longer and the shorter axis of the
       * parallels, then (3-D) the axis of the spiral, whose length differs most
       * from the others.
       */
      std::array<unsigned int, dim> order;
    };

    template <>
    SurfaceTiling<2>
    Ellipsoid<2>::tile(const std::uint64_t n_wished) const
    {
      const double a = half_axes[order[0]];
      const double b = half_axes[order[1]];
      const double k = std::sqrt((a - b) * (a + b)) / a;

      SurfaceTiling<2> tiling;
      tiling.n_patches  = std::max<std::uint64_t>(n_wished, 3);
      const double n    = static_cast<double>(tiling.n_patches);
      const double area = surface_area() / n;
      // The arcs have equal lengths, and each has its point in the middle.
      tiling.patch =
        [ellipse = *this, a, b, k, n, area](const std::uint64_t i) {
          const double angle =
            angle_at_fraction(k, (static_cast<double>(i) + 0.5) / n);
          Tensor<1, 2> from_center;
          from_center[ellipse.order[0]] = a * std::cos(angle);
          from_center[ellipse.order[1]] = b * std::sin(angle);
          return ellipse.patch_at(from_center, area);
        };
      return tiling;
    }

    template <>
    SurfaceTiling<3>
    Ellipsoid<3>::tile(const std::uint64_t n_wished) const
    {
      const Tensor<1, 3> axes(
        {half_axes[order[0]], half_axes[order[1]], half_axes[order[2]]});
      const Latitudes latitudes(axes[0], axes[1], axes[2]);

      SurfaceTiling<3> tiling;
      tiling.n_patches  = std::max<std::uint64_t>(n_wished, 4);
      const double n    = static_cast<double>(tiling.n_patches);
      const double area = surface_area() / n;
      // Heights share the area equally; along the parallels points follow the
      // golden angle, in the fraction of the parallel's area.
      tiling.patch = [ellipsoid = *this, axes, latitudes, n, area](
                       const std::uint64_t i) {
        const double height =
          latitudes.height((static_cast<double>(i) + 0.5) / n);
        const double parallel = std::sqrt((1. - height) * (1. + height));
        const double angle =
          angle_at_fraction(latitudes.modulus(height), golden_fraction(i));
        Tensor<1, 3> from_center;
        from_center[ellipsoid.order[0]] = axes[0] * parallel * std::cos(angle);
        from_center[ellipsoid.order[1]] = axes[1] * parallel * std::sin(angle);
        from_center[ellipsoid.order[2]] = axes[2] * height;
        return ellipsoid.patch_at(from_center, area);
      };
      return tiling;
    }
  } // namespace


  template <int dim>
  std::unique_ptr<Shape<dim>>
  make_ellipsoid(const TissueParameters &parameters)
  {
    return std::make_unique<Ellipsoid<dim>>(
      leading_components<dim>(parameters.center),
      0.5 * leading_components<dim>(parameters.size));
  }


  MORULA_INSTANTIATE(make_ellipsoid);
} // namespace Morula
