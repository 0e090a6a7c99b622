// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_seeding_shape_h
#define morula_seeding_shape_h

#include <morula/seeding/seeding.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /**
   * A surface cut into numbered patches. Each patch is computed on request, so
   * that a rank computes only its own. It may outlive the shape that made it.
   */
  template <int dim>
  struct SurfaceTiling
  {
    std::uint64_t                                   n_patches = 0;
    std::function<SurfacePatch<dim>(std::uint64_t)> patch;
  };

  /** The body that the initial tissue fills. Lengths in µm. */
  template <int dim>
  class Shape
  {
  public:
    virtual ~Shape() = default;

    virtual BoundingBox<dim>
    bounding_box() const = 0;

    /** Whether @p x lies inside, and farther than @p clearance (µm) from the
     *  surface. */
    virtual bool
    contains(const Point<dim> &x, const double clearance) const = 0;

    /** Whether a cube with the center @p x and this half side (µm) is inside,
     * or outside; nothing if the surface may cut it. */
    virtual std::optional<bool>
    side_of_cube(const Point<dim> &x, const double half_side) const;

    /** µm^dim */
    virtual double
    volume() const = 0;

    /** Area of the surface, in 2-D its length. */
    virtual double
    surface_area() const = 0;

    /**
     * Cuts the surface into @p n_wished patches, or into about as many as the
     * layout allows. Their areas add up to surface_area().
     */
    virtual SurfaceTiling<dim>
    tile(const std::uint64_t n_wished) const = 0;
  };

  /** Shapes that are made from their keys. */
  template <int dim>
  std::unique_ptr<Shape<dim>>
  make_ellipsoid(const TissueParameters &parameters);
  std::unique_ptr<Shape<3>>
  make_cylinder(const TissueParameters &parameters);
  std::unique_ptr<Shape<3>>
  make_mesh_shape(const TissueParameters &parameters);

  /**
   * The shape that the section "Tissue" names. It must not be 'points'.
   * @throws InputError if the shape does not exist in dim dimensions or its
   * mesh cannot be used
   */
  template <int dim>
  std::unique_ptr<Shape<dim>>
  make_shape(const TissueParameters &parameters);

  /** The first dim of the numbers that the user gave for a point or vector.
   */
  template <int dim>
  Point<dim>
  leading_components(const std::vector<double> &numbers);

  /**
   * The golden angle as a fraction of a turn, (3 - sqrt 5)/2. If each point of
   * a spiral is turned by it against the one before, the points spread evenly
   * on a surface of any aspect ratio.
   */
  constexpr double golden_turn = 0.381966011250105151795;

  /** Angle of the i-th point of a golden spiral in turns, in [0,1). */
  double
  golden_fraction(const std::uint64_t i);
} // namespace Morula

#endif
