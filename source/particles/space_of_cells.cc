// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/grid/grid_box.h>
#include <morula/particles/places.h>
#include <morula/particles/point_exchange.h>

#include <cstdint>
#include <set>
#include <tuple>

namespace Morula
{
  namespace
  {
    /** Where less of the space around a cell than this is inside, in grid
     *  cells, nothing is said of it; and what is said at most. */
    constexpr double least_space = 0.1, least_fill = 0.33, most_fill = 3.;

    /** The least volume around a place far from all patches, in grid cells, if
     *  it is inside. */
    constexpr double least_volume = 0.2;

    /** Volume and body of a cell; outward normal and body of a patch. */
    using VolumeOfBody = std::tuple<double, unsigned int>;
    template <int dim>
    using PlaneOfBody = std::tuple<Tensor<1, dim>, unsigned int>;

    /** The three quadratic splines that reach into a grid cell, at ξ in it. */
    std::array<double, 3>
    splines_at(const double xi)
    {
      return {{0.5 * (1. - xi) * (1. - xi), 0.5 + xi - xi * xi, 0.5 * xi * xi}};
    }

    /** Their integrals over [0, ξ], in grid spacings. */
    std::array<double, 3>
    splines_up_to(const double xi)
    {
      const double square = 0.5 * xi * xi, cube = xi * xi * xi / 3.;
      return {
        {0.5 * xi - square + 0.5 * cube, 0.5 * xi + square - cube, 0.5 * cube}};
    }

    /**
     * Volumes of the cells of a body, and the space inside its surface,
     * weighted by splines that are centred in grid cells and three of them
     * wide: m and S of doc/theory.md (6.11b), around the cells of this rank.
     */
    template <int dim>
    class SplineSums
    {
    public:
      /** @param cells   first those of this rank, then those of others
       *  @param patches those of this rank and of others
       *  @param bins    the patches */
      SplineSums(const PointList<dim> &cells,
                 const std::size_t     n_own,
                 const PointList<dim> &patches,
                 const PointBins<dim> &bins,
                 const unsigned int    body,
                 const GridBox<dim>   &box)
        : patches(patches)
        , bins(bins)
        , body(body)
        , box(box)
        , volumes(box.size())
        , space(box.size())
      {
        // The volumes are summed as integers, as the order of cells depends on
        // the ranks. Space is needed in the grid cells that share a spline with
        // one of an own cell.
        const double      scale = 1. / (unit * std::pow(box.spacing(), dim));
        std::vector<char> is_needed(box.size(), 0);
        unsigned int      last = box.size();
        for (std::size_t p = 0; p < cells.size(); ++p)
          {
            const auto [volume, of] = cells.template value<VolumeOfBody>(p);
            const Point<dim>    &x  = cells.positions[p];
            const GridIndex<dim> at = box.locate(x);
            if (of != body)
              continue;
            for_splines(x,
                        std::pow(volume, 1. / dim),
                        [&, V = volume](const unsigned int a, const double N) {
                          volumes[a] +=
                            static_cast<std::int64_t>(scale * V * N);
                        });
            if (p < n_own && box.number(at) != last)
              box.for_neighbors(at, 2, [&](const unsigned int i, const auto &) {
                is_needed[i] = 1;
              });
            last = box.number(at);
          }
        for (unsigned int i = 0; i < box.size(); ++i)
          if (is_needed[i])
            add_space(i);
      }

      /** Σ N m and Σ N S at @p x, in grid cells. */
      std::array<double, 2>
      at(const Point<dim> &x) const
      {
        std::array<double, 2> sums{};
        for_splines(x, 0., [&](const unsigned int a, const double N) {
          sums[0] += N * unit * volumes[a];
          sums[1] += N * space[a];
        });
        return sums;
      }

    private:
      static constexpr double unit = 1. / (1ll << 40); // of volumes, grid cells
      /** Boxes along the edge of a grid cell that the surface cuts. */
      static constexpr unsigned int n_boxes = 6 - dim;

      /** Calls visit(number, value) for the means of the splines over a cube of
       *  the edge @p l (um) around @p x. */
      template <typename Visit>
      void
      for_splines(const Point<dim> &x, const double l, const Visit &visit) const
      {
        // Grid cells around cells are in the box. The second derivatives of the
        // splines there are 1, -2 and 1.
        const double     spread = l * l / (24. * box.spacing() * box.spacing());
        GridIndex<dim>   at     = box.locate(x);
        const Point<dim> xi     = box.unit_position(x, at);
        std::array<std::array<double, 3>, dim> N;
        for (unsigned int d = 0; d < dim; ++d)
          {
            N[d] = splines_at(xi[d]);
            N[d][0] += spread;
            N[d][1] -= 2. * spread;
            N[d][2] += spread;
            --at[d];
          }
        const unsigned int first = box.number(at), n_x = box.n()[0],
                           n_xy = n_x * box.n()[1];
        for (unsigned int k = 0; k < (dim == 3 ? 3 : 1); ++k)
          for (unsigned int j = 0; j < 3; ++j)
            for (unsigned int i = 0; i < 3; ++i)
              visit(first + i + j * n_x + k * n_xy,
                    N[0][i] * N[1][j] * (dim == 3 ? N[dim - 1][k] : 1.));
      }

      void
      add_space(const unsigned int i);

      /** Which of some patches is nearest to @p x; of those that are equally
       *  near but for rounding, that of the lowest id. */
      unsigned int
      nearest(const Point<dim> &x, const std::vector<unsigned int> &near) const
      {
        constexpr double rounding = 1. + 1e-6;
        const auto       far      = [&](const unsigned int b) {
          return x.distance_square(patches.positions[b]);
        };
        double least = far(near.at(0));
        for (const unsigned int b : near)
          least = std::min(least, far(b));
        unsigned int found = numbers::invalid_unsigned_int;
        for (const unsigned int b : near)
          if (far(b) <= rounding * least &&
              (found == numbers::invalid_unsigned_int ||
               patches.ids[b] < patches.ids[found]))
            found = b;
        return found;
      }

      const PointList<dim>     &patches;
      const PointBins<dim>     &bins;
      const unsigned int        body;
      const GridBox<dim>       &box;
      std::vector<std::int64_t> volumes; // by grid cell
      std::vector<double>       space;   // likewise, in grid cells
    };


    template <int dim>
    void
    SplineSums<dim>::add_space(const unsigned int i)
    {
      // A grid cell without patches near it is inside if it has cells enough
      // around it. Others are taken box by box. The plane of the nearest patch
      // cuts a box; the part of it below the plane is linear in the depth of
      // its centre.
      const double              h  = box.spacing();
      const GridIndex<dim>      at = box.index(i);
      std::vector<unsigned int> near;
      bins.visit_within(box.center(at), 1.5 * h, [&](const unsigned int b) {
        if (std::get<1>(patches.template value<PlaneOfBody<dim>>(b)) == body)
          near.push_back(b);
      });
      if (near.empty() && unit * volumes[i] < least_volume)
        return;
      const unsigned int n    = near.empty() ? 1 : n_boxes;
      const double       edge = h / n;
      for (unsigned int k = 0; k < Utilities::pow(n, dim); ++k)
        {
          Point<dim>                             x = box.corner(at);
          std::array<std::array<double, 3>, dim> N;
          for (unsigned int d = 0, rest = k; d < dim; ++d, rest /= n)
            {
              x[d] += (rest % n + 0.5) * edge;
              const auto lower = splines_up_to(rest % n / double(n));
              N[d]             = splines_up_to((rest % n + 1) / double(n));
              for (unsigned int s = 0; s < 3; ++s)
                N[d][s] -= lower[s];
            }
          double part = 1.;
          if (!near.empty())
            {
              const unsigned int b = nearest(x, near);
              const auto         normal =
                std::get<0>(patches.template value<PlaneOfBody<dim>>(b));
              double steepest = 0.;
              for (unsigned int d = 0; d < dim; ++d)
                steepest = std::max(steepest, std::abs(normal[d]));
              part = std::clamp(0.5 + normal * (patches.positions[b] - x) /
                                        (edge * steepest),
                                0.,
                                1.);
            }
          box.for_neighbors(at, 1, [&](const unsigned int a, const auto &i) {
            double integral = 1.;
            for (unsigned int d = 0; d < dim; ++d)
              integral *= N[d][i[d] - at[d] + 1];
            space[a] += part * integral;
          });
        }
    }
  } // namespace


  template <int dim>
  SpaceOfCells
  space_of_cells(const Tissue<dim> &tissue)
  {
    // Cells two grid cells away share a spline, whose integral needs to know
    // what is around the grid cells there.
    const Cells<dim>          &cells  = tissue.cells();
    const BoundaryPoints<dim> &points = tissue.boundary_points();
    const GridBox<dim>        &box    = tissue.grid().box();
    PointList<dim>             volumes(Flat<VolumeOfBody>::n);
    PointList<dim>             patches(Flat<PlaneOfBody<dim>>::n);
    std::set<unsigned int>     bodies;
    volumes.reserve(cells.size());
    for (unsigned int p = 0; p < cells.size(); ++p)
      {
        bodies.insert(cells.body(p));
        volumes.add_value(cells.id(p),
                          cells.position(p),
                          VolumeOfBody(cells.volume(p), cells.body(p)));
      }
    for (unsigned int b = 0; b < points.size(); ++b)
      {
        const Tensor<1, dim> area = points.area_vector(b);
        patches.add_value(points.id(b),
                          points.position(b),
                          PlaneOfBody<dim>(area / area.norm(), points.body(b)));
      }
    volumes.append(halo(volumes, tissue.grid(), 4. * box.spacing()));
    patches.append(halo(patches, tissue.grid(), 4. * box.spacing()));

    SpaceOfCells         result{std::vector<double>(cells.size(), 1.),
                        std::vector<double>(cells.size(), 0.)};
    const PointBins<dim> bins(box, patches.positions);
    for (const unsigned int body : bodies)
      {
        const SplineSums<dim> sums(
          volumes, cells.size(), patches, bins, body, box);
        for (unsigned int p = 0; p < cells.size(); ++p)
          if (cells.body(p) == body)
            if (const auto [m, S] = sums.at(cells.position(p)); S > least_space)
              {
                result.fill[p]   = std::clamp(m / S, least_fill, most_fill);
                result.inside[p] = std::min(1., S);
              }
      }
    return result;
  }

  MORULA_INSTANTIATE(space_of_cells);
} // namespace Morula
