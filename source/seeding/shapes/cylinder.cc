// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/shape.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The place of a patch on a surface that is cut into rings. */
    struct RingPlace
    {
      /** The fraction of the whole area that lies before the middle of its
       * ring.
       */
      double area_before;
      /** Angle around the axis, radians. */
      double angle;
      /** The patch's fraction of the whole area. */
      double area;
    };

    /**
     * Cuts a surface of revolution into rings, and each ring into patches of
     * equal area, evenly around the axis.
     */
    class Rings
    {
    public:
      /**
       * @param n_patches   number of all patches
       * @param area_before for each ring but the last, the fraction of the area
       * up to its end, increasing. A ring's end is moved by up to half a patch.
       */
      Rings(const std::uint64_t        n_patches,
            const std::vector<double> &area_before)
        : ends(1, 0)
      {
        // A ring ends where the patches so far have the area so far, rounded.
        // Rings without patches are left out.
        for (const double area : area_before)
          {
            const auto end = static_cast<std::uint64_t>(
              std::round(area * static_cast<double>(n_patches)));
            if (end > ends.back() && end < n_patches)
              ends.push_back(end);
          }
        ends.push_back(n_patches);
      }

      /** The @p i-th patch, ring by ring. */
      RingPlace
      place(const std::uint64_t i) const
      {
        const auto end  = std::upper_bound(ends.begin(), ends.end(), i);
        const auto ring = std::distance(ends.begin(), end);

        const double n     = static_cast<double>(n_patches());
        const double first = static_cast<double>(*(end - 1));
        const double count = static_cast<double>(*end) - first;
        // Every second ring begins half a patch later, so that patches do not
        // stand in rows.
        const double shift = ring % 2 == 0 ? 0.75 : 0.25;
        return {(first + 0.5 * count) / n,
                2. * dealii::numbers::PI *
                  (static_cast<double>(i) - first + shift) / count,
                1. / n};
      }

      std::uint64_t
      n_patches() const
      {
        return ends.back();
      }

    private:
      // The number of patches before each ring's end; the first entry is 0.
      std::vector<std::uint64_t> ends;
    };

    /** A solid cylinder along z. */
    class Cylinder : public Shape<3>
    {
    public:
      /** @param radius, height radius and full height, µm */
      Cylinder(const Point<3> &center, const double radius, const double height)
        : center(center)
        , radius(radius)
        , height(height)
      {}

      BoundingBox<3>
      bounding_box() const override
      {
        const Tensor<1, 3> half({radius, radius, 0.5 * height});
        return BoundingBox<3>({center - half, center + half});
      }

      bool
      contains(const Point<3> &x, const double clearance) const override
      {
        return std::hypot(x[0] - center[0], x[1] - center[1]) <
                 radius - clearance &&
               std::abs(x[2] - center[2]) < 0.5 * height - clearance;
      }

      double
      volume() const override
      {
        return cap_area() * height;
      }

      double
      surface_area() const override
      {
        return side_area() + 2. * cap_area();
      }

      /**
       * Rings of patches of equal area: on the lower cap from the middle
       * outwards, then up the side, then on the upper cap. A cap has at least
       * one patch, the side at least three.
       */
      SurfaceTiling<3>
      tile(const std::uint64_t n_wished) const override
      {
        // The wished number is shared between the caps and the side by area,
        // with at least one patch for each cap and three for the side. Both are
        // divided into rings of about square patches: on a cap equally wide
        // ones, on the side equally high ones. What is kept is the fraction of
        // the area below each ring; a patch follows from its number.
        const double on_cap =
          static_cast<double>(n_wished) * cap_area() / surface_area();
        const std::uint64_t n_cap =
          static_cast<std::uint64_t>(std::max(1., std::round(on_cap)));
        const std::uint64_t n_side =
          std::max<std::uint64_t>(n_wished, 2 * n_cap + 3) - 2 * n_cap;

        // Rings of a cap are as wide as a square patch, and n of them hold
        // about pi n² patches.
        const double n_cap_rings =
          std::max(1., std::round(std::sqrt(n_cap / numbers::PI)));
        std::vector<double> cap_areas;
        for (double ring = 1.; ring < n_cap_rings; ++ring)
          cap_areas.push_back(ring * ring / (n_cap_rings * n_cap_rings));

        const double patch_length = std::sqrt(side_area() / n_side);
        const double n_side_rings =
          std::min(std::max(1., std::round(height / patch_length)),
                   std::floor(n_side / 3.));
        std::vector<double> side_areas;
        for (double ring = 1.; ring < n_side_rings; ++ring)
          side_areas.push_back(ring / n_side_rings);

        const Rings cap(n_cap, cap_areas), side(n_side, side_areas);

        SurfaceTiling<3> tiling;
        tiling.n_patches = n_side + 2 * n_cap;
        tiling.patch = [cylinder = *this, cap, side](const std::uint64_t i) {
          const std::uint64_t n_cap  = cap.n_patches(),
                              n_side = side.n_patches();
          if (i < n_cap)
            return cylinder.cap_patch(cap.place(i), -1.);
          if (i < n_cap + n_side)
            return cylinder.side_patch(side.place(i - n_cap));
          return cylinder.cap_patch(cap.place(i - n_cap - n_side), 1.);
        };
        return tiling;
      }

    private:
      double
      cap_area() const
      {
        return numbers::PI * radius * radius;
      }

      double
      side_area() const
      {
        return 2. * numbers::PI * radius * height;
      }

      /** @param side -1: lower, 1: upper */
      SurfacePatch<3>
      cap_patch(const RingPlace &place, const double side) const
      {
        // A patch's radius halves the area of its ring. If the ring in the
        // middle of the cap has only one patch, that patch is a disc, and its
        // point is in the middle.
        const bool   is_disc = 2. * place.area_before == place.area;
        const double r = is_disc ? 0. : radius * std::sqrt(place.area_before);

        SurfacePatch<3> patch;
        patch.position = center + Tensor<1, 3>({r * std::cos(place.angle),
                                                r * std::sin(place.angle),
                                                0.5 * side * height});
        patch.normal   = Tensor<1, 3>({0., 0., side});
        patch.area     = place.area * cap_area();
        return patch;
      }

      SurfacePatch<3>
      side_patch(const RingPlace &place) const
      {
        const double z = height * (place.area_before - 0.5);

        SurfacePatch<3> patch;
        patch.normal =
          Tensor<1, 3>({std::cos(place.angle), std::sin(place.angle), 0.});
        patch.position =
          center + radius * patch.normal + Tensor<1, 3>({0., 0., z});
        patch.area = place.area * side_area();
        return patch;
      }

      Point<3> center;
      double   radius;
      double   height;
    };
  } // namespace


  std::unique_ptr<Shape<3>>
  make_cylinder(const TissueParameters &parameters)
  {
    return std::make_unique<Cylinder>(leading_components<3>(parameters.center),
                                      parameters.radius,
                                      parameters.size->at(2));
  }
} // namespace Morula
