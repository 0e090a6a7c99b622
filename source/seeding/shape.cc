// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/numbers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace Morula
{
  template <int dim>
  std::optional<bool>
  Shape<dim>::side_of_cube(const Point<dim> &x, const double half_side) const
  {
    return this->contains(x, std::sqrt(double(dim)) * half_side) ?
             std::optional<bool>(true) :
             std::nullopt;
  }


  template <int dim>
  Point<dim>
  leading_components(const std::vector<double> &numbers)
  {
    AssertThrow(numbers.size() >= dim,
                ExcDimensionMismatch(numbers.size(), dim));
    Point<dim> p;
    for (unsigned int d = 0; d < dim; ++d)
      p[d] = numbers[d];
    return p;
  }

  double
  golden_fraction(const std::uint64_t i)
  {
    const double turns = static_cast<double>(i) * golden_turn;
    return turns - std::floor(turns);
  }


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


    template <int dim>
    using EdgeCounts = std::array<std::uint64_t, dim>;

    /** Number of patches on a face whose normal is along @p direction. */
    template <int dim>
    std::uint64_t
    n_on_face(const EdgeCounts<dim> &counts, const unsigned int direction)
    {
      std::uint64_t n = 1;
      for (unsigned int d = 0; d < dim; ++d)
        if (d != direction)
          // Faces are perpendicular to each direction, two of them.
          n *= counts[d];
      return n;
    }

    template <int dim>
    std::uint64_t
    n_on_box(const EdgeCounts<dim> &counts)
    {
      std::uint64_t n = 0;
      for (unsigned int d = 0; d < dim; ++d)
        n += 2 * n_on_face<dim>(counts, d);
      return n;
    }

    /**
     * The number of pieces of each edge. It is the edge's length in units of
     * the wished patch's, rounded up or down such that the total number of
     * patches comes nearest to the wish.
     */
    template <int dim>
    EdgeCounts<dim>
    cut_edges(const Tensor<1, dim> &size,
              const double          patch_length,
              const std::uint64_t   n_wished)
    {
      // All combinations of rounding up and down are tried. Edges of equal
      // length must have equally many pieces, so that a cube stays symmetric.
      EdgeCounts<dim> best{};
      double          best_error = std::numeric_limits<double>::max();
      for (unsigned int up = 0; up < (1u << dim); ++up)
        {
          EdgeCounts<dim> counts;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double exact = size[d] / patch_length;
              // Rounding errors must not turn 22 into 21.
              const double whole = std::floor(exact * (1. + 1e-12));
              counts[d]          = static_cast<std::uint64_t>(
                std::max(1., whole + ((up >> d) & 1u)));
            }
          bool equal_edges_equal = true;
          for (unsigned int d = 1; d < dim; ++d)
            for (unsigned int e = 0; e < d; ++e)
              equal_edges_equal &= size[d] != size[e] || counts[d] == counts[e];
          const double error =
            std::abs(static_cast<double>(n_on_box<dim>(counts)) -
                     static_cast<double>(n_wished));
          if (equal_edges_equal && error < best_error)
            {
              best       = counts;
              best_error = error;
            }
        }
      return best;
    }

    /** An axis-parallel box; in 2-D, a rectangle. */
    template <int dim>
    class Box : public Shape<dim>
    {
    public:
      /** @param size full edge lengths, µm */
      Box(const Point<dim> &center, const Tensor<1, dim> &size)
        : center(center)
        , size(size)
      {}

      BoundingBox<dim>
      bounding_box() const override
      {
        return BoundingBox<dim>({center - 0.5 * size, center + 0.5 * size});
      }

      bool
      contains(const Point<dim> &x, const double clearance) const override
      {
        for (unsigned int d = 0; d < dim; ++d)
          if (!(std::abs(x[d] - center[d]) < 0.5 * size[d] - clearance))
            return false;
        return true;
      }

      double
      volume() const override
      {
        double product = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          product *= size[d];
        return product;
      }

      double
      surface_area() const override
      {
        double area = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            double face = 1.;
            for (unsigned int e = 0; e < dim; ++e)
              if (e != d)
                face *= size[e];
            area += 2. * face;
          }
        return area;
      }

      /**
       * A grid of patches on each face: -x, +x, -y, ...; within a face the
       * lower coordinate fastest. Edges of equal length have equal numbers of
       * patches.
       */
      SurfaceTiling<dim>
      tile(const std::uint64_t n_wished) const override
      {
        // The patch number i counts through the faces, two for each direction,
        // and on a face through the products of the pieces along its edges. So
        // a patch is made from its number alone, on any rank.
        const double patch_length =
          std::pow(surface_area() / static_cast<double>(n_wished),
                   1. / (dim - 1));
        const EdgeCounts<dim> counts = cut_edges(size, patch_length, n_wished);

        SurfaceTiling<dim> tiling;
        tiling.n_patches = n_on_box<dim>(counts);
        tiling.patch     = [box = *this, counts](std::uint64_t i) {
          unsigned int face = 0;
          for (; i >= n_on_face<dim>(counts, face / 2); ++face)
            i -= n_on_face<dim>(counts, face / 2);

          const unsigned int direction = face / 2;
          const double       side      = face % 2 == 0 ? -1. : 1.;
          SurfacePatch<dim>  patch;
          patch.area              = 1.;
          patch.normal[direction] = side;
          for (unsigned int d = 0; d < dim; ++d)
            if (d == direction)
              patch.position[d] = box.center[d] + 0.5 * side * box.size[d];
            else
              {
                // Places are measured from the middle, so that mirror images
                // are exact.
                const double n = static_cast<double>(counts[d]);
                const double step =
                  static_cast<double>(i % counts[d]) + 0.5 - 0.5 * n;
                patch.position[d] = box.center[d] + box.size[d] * (step / n);
                patch.area *= box.size[d] / n;
                i /= counts[d];
              }
          return patch;
        };
        return tiling;
      }

    private:
      Point<dim>     center;
      Tensor<1, dim> size;
    };
  } // namespace


  template <int dim>
  std::unique_ptr<Shape<dim>>
  make_shape(const TissueParameters &parameters)
  {
    // The parameters' own check has refused what does not exist in this
    // dimension, so the last line is reached by points only, which have no
    // inside.
    const std::string &shape = parameters.shape;
    if (shape == "sphere")
      return std::make_unique<Sphere<dim>>(leading_components<dim>(
                                             parameters.center),
                                           parameters.radius,
                                           parameters.inner_radius);
    if (shape == "box")
      return std::make_unique<Box<dim>>(
        leading_components<dim>(parameters.center),
        leading_components<dim>(parameters.size));
    if (shape == "ellipsoid")
      return make_ellipsoid<dim>(parameters);
    if constexpr (dim == 3)
      {
        if (shape == "cylinder")
          return make_cylinder(parameters);
        if (shape == "mesh")
          return make_mesh_shape(parameters);
      }
    parameters.shape.refuse("a shape that has an inside", "Choose another.");
  }

  template class Shape<2>;
  template class Shape<3>;
  MORULA_INSTANTIATE(leading_components);
  MORULA_INSTANTIATE(make_shape);
} // namespace Morula
