// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/shape.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

namespace Morula
{
  namespace
  {
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
  make_box(const TissueParameters &parameters)
  {
    return std::make_unique<Box<dim>>(leading_components<dim>(
                                        parameters.center),
                                      leading_components<dim>(parameters.size));
  }


  MORULA_INSTANTIATE(make_box);
} // namespace Morula
