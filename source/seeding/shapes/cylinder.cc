// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/shapes/cylinder.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace Morula
{
  Cylinder::Cylinder(const Point<3> &center,
                     const double    radius,
                     const double    height)
    : center(center)
    , radius(radius)
    , height(height)
  {}

  BoundingBox<3>
  Cylinder::bounding_box() const
  {
    const Tensor<1, 3> half({radius, radius, 0.5 * height});
    return BoundingBox<3>({center - half, center + half});
  }

  bool
  Cylinder::contains(const Point<3> &x, const double clearance) const
  {
    return std::hypot(x[0] - center[0], x[1] - center[1]) <
             radius - clearance &&
           std::abs(x[2] - center[2]) < 0.5 * height - clearance;
  }

  SurfacePatch<3>
  Cylinder::cap_patch(const RingPlace &place, const double side) const
  {
    // A patch's radius halves the area of its ring. If the ring in the middle
    // of the cap has only one patch, that patch is a disc, and its point is in
    // the middle.
    const bool   is_disc = 2. * place.area_before == place.area;
    const double r       = is_disc ? 0. : radius * std::sqrt(place.area_before);

    SurfacePatch<3> patch;
    patch.position = center + Tensor<1, 3>({r * std::cos(place.angle),
                                            r * std::sin(place.angle),
                                            0.5 * side * height});
    patch.normal   = Tensor<1, 3>({0., 0., side});
    patch.area     = place.area * cap_area();
    return patch;
  }

  SurfacePatch<3>
  Cylinder::side_patch(const RingPlace &place) const
  {
    const double z = height * (place.area_before - 0.5);

    SurfacePatch<3> patch;
    patch.normal =
      Tensor<1, 3>({std::cos(place.angle), std::sin(place.angle), 0.});
    patch.position = center + radius * patch.normal + Tensor<1, 3>({0., 0., z});
    patch.area     = place.area * side_area();
    return patch;
  }

  SurfaceTiling<3>
  Cylinder::tile(const std::uint64_t n_wished) const
  {
    // The wished number is shared between the caps and the side by area, with
    // at least one patch for each cap and three for the side. Both are divided
    // into rings of about square patches: on a cap equally wide ones, on the
    // side equally high ones. What is kept is the fraction of the area below
    // each ring; a patch follows from its number.
    const double on_cap =
      static_cast<double>(n_wished) * cap_area() / surface_area();
    const std::uint64_t n_cap =
      static_cast<std::uint64_t>(std::max(1., std::round(on_cap)));
    const std::uint64_t n_side =
      std::max<std::uint64_t>(n_wished, 2 * n_cap + 3) - 2 * n_cap;

    // Rings of a cap are as wide as a square patch, and n of them hold about pi
    // n² patches.
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
    tiling.patch     = [cylinder = *this, cap, side](const std::uint64_t i) {
      const std::uint64_t n_cap = cap.n_patches(), n_side = side.n_patches();
      if (i < n_cap)
        return cylinder.cap_patch(cap.place(i), -1.);
      if (i < n_cap + n_side)
        return cylinder.side_patch(side.place(i - n_cap));
      return cylinder.cap_patch(cap.place(i - n_cap - n_side), 1.);
    };
    return tiling;
  }
} // namespace Morula
