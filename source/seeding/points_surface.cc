// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/seeding/mesh_patches.h>
#include <morula/seeding/points_surface.h>
#include <morula/seeding/points_surface_mesh.h>
#include <morula/seeding/share.h>

#include <deal.II/base/mpi.h>
#include <deal.II/boost_adaptors/bounding_box.h>
#include <deal.II/boost_adaptors/point.h>
#include <deal.II/numerics/rtree.h>

#include <boost/pending/disjoint_sets.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>

namespace Morula
{
  namespace
  {
    namespace bgi = boost::geometry::index;

    /** All cells, on rank 0. */
    template <int dim>
    struct AllCells
    {
      std::vector<Point<dim>> positions; // um
      std::vector<double>     volumes;   // um^dim
      double                  volume = 0.;
      double                  length = 0.; // of the mean cell, um
    };

    template <int dim>
    AllCells<dim>
    gather(const Founders<dim> &founders, const MPI_Comm comm)
    {
      AllCells<dim> all;
      for (const auto &part : Utilities::MPI::gather(comm, founders.positions))
        all.positions.insert(all.positions.end(), part.begin(), part.end());
      for (const auto &part : Utilities::MPI::gather(comm, founders.volumes))
        all.volumes.insert(all.volumes.end(), part.begin(), part.end());
      for (const double V : all.volumes)
        all.volume += V;
      if (!all.volumes.empty())
        all.length = std::pow(all.volume / all.volumes.size(), 1. / dim);
      return all;
    }

    /**
     * The part of space that cells fill, smoothed: each cell spreads its volume
     * as a Gaussian. Of cells side by side on a lattice, whatever its
     * direction, it is 1 inside, to 0.5 %, and 1/2 where they end:
     * doc/theory.md (1.9).
     */
    template <int dim>
    class Filling
    {
    public:
      explicit Filling(const AllCells<dim> &cells)
        : cells(cells)
        , sigma(0.6 * cells.length)
        , tree(pack_rtree_of_indices(cells.positions))
      {}

      std::pair<double, Tensor<1, dim>>
      value_and_gradient(const Point<dim> &x) const
      {
        const double                      reach = 4. * sigma;
        std::pair<Point<dim>, Point<dim>> corners(x, x);
        for (unsigned int d = 0; d < dim; ++d)
          {
            corners.first[d] -= reach;
            corners.second[d] += reach;
          }
        std::vector<std::size_t> near;
        tree.query(bgi::intersects(BoundingBox<dim>(corners)),
                   std::back_inserter(near));
        std::sort(near.begin(), near.end());
        const double scale =
          std::pow(2. * numbers::PI * sigma * sigma, -0.5 * dim);
        std::pair<double, Tensor<1, dim>> result;
        for (const std::size_t i : near)
          {
            const Tensor<1, dim> way = x - cells.positions[i];
            const double         part =
              scale * cells.volumes[i] *
              std::exp(-0.5 * way.norm_square() / (sigma * sigma));
            result.first += part;
            result.second -= part / (sigma * sigma) * way;
          }
        return result;
      }

      /** The upper quartile over some cells: what it is inside. */
      double
      inside() const
      {
        constexpr std::size_t most = 1000;
        const std::size_t     every =
          std::max<std::size_t>(1, cells.positions.size() / most);
        std::vector<double> values;
        for (std::size_t i = 0; i < cells.positions.size(); i += every)
          values.push_back(value_and_gradient(cells.positions[i]).first);
        const auto quartile = values.begin() + values.size() * 3 / 4;
        std::nth_element(values.begin(), quartile, values.end());
        return *quartile;
      }

    private:
      using Tree = decltype(pack_rtree_of_indices(
        std::declval<const std::vector<Point<dim>> &>()));

      const AllCells<dim> &cells;
      const double         sigma;
      const Tree           tree;
    };

    /** Moves the vertices to where the filling falls to half, by no more than
     *  3/4 of a cell. */
    template <int dim>
    void
    move_to_half(const AllCells<dim> &cells, ClosedSurface<dim> &surface)
    {
      const Filling<dim> filling(cells);
      const double       half = 0.5 * filling.inside();
      for (Point<dim> &x : surface.vertices)
        {
          const Point<dim> start = x;
          for (unsigned int i = 0; i < 20; ++i)
            {
              const auto [value, slope] = filling.value_and_gradient(x);
              if (slope.norm() * cells.length < 1e-6)
                break; // no cell is near
              Tensor<1, dim> step =
                (half - value) / slope.norm_square() * slope;
              const double longest = 0.25 * cells.length;
              if (step.norm() > longest)
                step *= longest / step.norm();
              x += step;
              if (x.distance(start) > 0.75 * cells.length)
                {
                  x = start +
                      (0.75 * cells.length / x.distance(start)) * (x - start);
                  break;
                }
              if (step.norm() < 1e-6 * cells.length)
                break;
            }
        }
    }

    Tensor<1, 2>
    facet_vector(const ClosedSurface<2> &surface, const std::size_t f)
    {
      return cross_product_2d(surface.vertices[surface.facets[f][1]] -
                              surface.vertices[surface.facets[f][0]]);
    }

    Tensor<1, 3>
    facet_vector(const ClosedSurface<3> &surface, const std::size_t f)
    {
      const auto &[a, b, c] = surface.facets[f];
      return area_vector(
        {{surface.vertices[a], surface.vertices[b], surface.vertices[c]}});
    }

    template <int dim>
    double
    enclosed_volume(const ClosedSurface<dim> &surface)
    {
      // from a point of the surface, so that no digits are lost far away
      const Point<dim> apex   = surface.vertices.front();
      double           volume = 0.;
      for (std::size_t f = 0; f < surface.facets.size(); ++f)
        volume += (surface.vertices[surface.facets[f][0]] - apex) *
                  facet_vector(surface, f);
      return volume / dim;
    }

    template <int dim>
    double
    total_area(const ClosedSurface<dim> &surface)
    {
      double area = 0.;
      for (std::size_t f = 0; f < surface.facets.size(); ++f)
        area += facet_vector(surface, f).norm();
      return area;
    }

    /** Moves the vertices along the normals, all as far, by no more than a
     *  quarter of a cell, so that the surface encloses the cells' volume. */
    template <int dim>
    void
    match_volume(const AllCells<dim> &cells, ClosedSurface<dim> &surface)
    {
      double so_far = 0.;
      for (unsigned int i = 0; i < 5; ++i)
        {
          const double limit = 0.25 * cells.length;
          const double way =
            std::clamp(so_far + (cells.volume - enclosed_volume(surface)) /
                                  total_area(surface),
                       -limit,
                       limit) -
            so_far;
          std::vector<Tensor<1, dim>> normals(surface.vertices.size());
          for (std::size_t f = 0; f < surface.facets.size(); ++f)
            for (const unsigned int v : surface.facets[f])
              normals[v] += facet_vector(surface, f);
          for (std::size_t v = 0; v < normals.size(); ++v)
            if (normals[v].norm() > 0.)
              surface.vertices[v] += way / normals[v].norm() * normals[v];
          so_far += way;
        }
    }

    /** Cuts segments that are longer than @p longest, um, into equal ones. */
    void
    cut_segments(const double longest, ClosedSurface<2> &surface)
    {
      std::vector<std::array<unsigned int, 2>> cut;
      for (const auto &[from, to] : surface.facets)
        {
          const Point<2>     a    = surface.vertices[from];
          const Point<2>     b    = surface.vertices[to];
          const unsigned int n    = std::ceil(a.distance(b) / longest);
          unsigned int       last = from;
          for (unsigned int i = 1; i < n; ++i)
            {
              surface.vertices.push_back(a + (double(i) / n) * (b - a));
              const auto next =
                static_cast<unsigned int>(surface.vertices.size() - 1);
              cut.push_back({{last, next}});
              last = next;
            }
          cut.push_back({{last, to}});
        }
      surface.facets = std::move(cut);
    }

    /** The surface's parts, each as the vertices along it. */
    std::vector<std::vector<Point<2>>>
    loops(const ClosedSurface<2> &surface)
    {
      std::multimap<unsigned int, unsigned int> next;
      for (const auto &[from, to] : surface.facets)
        next.emplace(from, to);
      std::vector<std::vector<Point<2>>> all;
      while (!next.empty())
        {
          all.emplace_back();
          for (auto step = next.begin(); step != next.end();)
            {
              all.back().push_back(surface.vertices[step->first]);
              const unsigned int to = step->second;
              next.erase(step);
              step = next.find(to);
            }
        }
      return all;
    }

    /** The place at @p way, um, along a closed line; lengths[i] is the way from
     *  its begin to its vertex i, and the last one is that around it. */
    Point<2>
    place_along(const std::vector<Point<2>> &line,
                const std::vector<double>   &lengths,
                const double                 way)
    {
      const std::size_t n = line.size();
      const std::size_t i =
        std::min<std::size_t>(std::upper_bound(lengths.begin(),
                                               lengths.end(),
                                               way) -
                                lengths.begin(),
                              n) -
        1;
      const double part =
        std::clamp((way - lengths[i]) / (lengths[i + 1] - lengths[i]), 0., 1.);
      return line[i] + part * (line[(i + 1) % n] - line[i]);
    }

    std::vector<SurfacePatch<2>>
    patches(const ClosedSurface<2> &surface, const std::uint64_t n_wished)
    {
      const double                 length = total_area(surface) / n_wished;
      std::vector<SurfacePatch<2>> all;
      for (const std::vector<Point<2>> &line : loops(surface))
        {
          std::vector<double> lengths(1, 0.);
          for (std::size_t i = 0; i < line.size(); ++i)
            lengths.push_back(lengths.back() +
                              line[i].distance(line[(i + 1) % line.size()]));
          // fewer would enclose nothing
          const double n  = std::max(3., std::round(lengths.back() / length));
          const auto   at = [&](const double i) {
            return place_along(line, lengths, i / n * lengths.back());
          };
          for (double i = 0.; i < n; ++i)
            {
              const Tensor<1, 2> vector =
                cross_product_2d(at(i + 1 < n ? i + 1 : 0) - at(i));
              if (vector.norm() > 1e-9 * length)
                all.push_back(
                  {at(i + 0.5), vector / vector.norm(), vector.norm()});
            }
        }
      return all;
    }

    std::vector<SurfacePatch<3>>
    patches(const ClosedSurface<3> &surface, const std::uint64_t n_wished)
    {
      std::map<std::pair<unsigned int, unsigned int>, unsigned int> facet_of;
      for (std::size_t f = 0; f < surface.facets.size(); ++f)
        for (unsigned int i = 0; i < 3; ++i)
          facet_of[{surface.facets[f][i], surface.facets[f][(i + 1) % 3]}] =
            static_cast<unsigned int>(f);
      std::vector<SurfaceTriangle> triangles;
      for (const std::array<unsigned int, 3> &facet : surface.facets)
        {
          SurfaceTriangle triangle;
          for (unsigned int i = 0; i < 3; ++i)
            {
              triangle.vertices[i] = surface.vertices[facet[i]];
              triangle.neighbors[i] =
                facet_of.at({facet[(i + 1) % 3], facet[i]});
            }
          triangles.push_back(triangle);
        }
      return cut_into_patches(triangles, n_wished, PatchArea::projected);
    }

    /** Refuses cells around which there is no common surface. */
    template <int dim>
    void
    check_surface(const TissueParameters   &parameters,
                  const AllCells<dim>      &cells,
                  const ClosedSurface<dim> &surface)
    {
      const double ratio = enclosed_volume(surface) / cells.volume;
      boost::disjoint_sets_with_storage<> bodies(surface.vertices.size());
      std::vector<std::size_t>            all(surface.vertices.size());
      std::iota(all.begin(), all.end(), 0);
      for (const auto &facet : surface.facets)
        for (const unsigned int v : facet)
          bodies.union_set(std::size_t(facet[0]), std::size_t(v));
      const std::size_t n = bodies.count_sets(all.begin(), all.end());
      if (ratio > 0.5 && ratio < 2. &&
          (n == 1 || 2 * n <= cells.volumes.size()))
        return;
      std::ostringstream found;
      found << "It would have " << n << (n == 1 ? " part" : " parts") << " for "
            << cells.volumes.size() << " cells and enclose " << as_text(ratio)
            << " of their volume: they "
            << (ratio > 0.5 ? "leave gaps" : "overlap") << '.';
      parameters.points_file.refuse(
        "cells side by side, as there is a surface around them (Tissue/Points "
        "surface = " +
          parameters.points_surface + ')',
        found.str() +
          " If the file is in another unit, scale it to um; else give each "
          "cell its volume, or set Tissue/Cell spacing to their length; or set "
          "Points surface = none.");
    }

    template <int dim>
    ClosedSurface<dim>
    surface_around(const TissueParameters &parameters,
                   const AllCells<dim>    &cells)
    {
      ClosedSurface<dim> surface = wrap_points(cells.positions, cells.length);
      if constexpr (dim == 2)
        cut_segments(0.5 * cells.length, surface);
      move_to_half(cells, surface);
      match_volume(cells, surface);
      check_surface(parameters, cells, surface);
      return surface;
    }

    /** This rank's share of what rank 0 has. */
    template <int dim>
    SurfacePatches<dim>
    shares(const SurfacePatches<dim> &all, const MPI_Comm comm)
    {
      const auto take = [comm](const auto &list, auto &mine) {
        const auto everything   = Utilities::MPI::broadcast(comm, list, 0);
        const auto [begin, end] = share(everything.size(), comm);
        mine.assign(everything.begin() + begin, everything.begin() + end);
      };
      SurfacePatches<dim> mine;
      take(all.positions, mine.positions);
      take(all.normals, mine.normals);
      take(all.areas, mine.areas);
      const std::uint64_t n =
        Utilities::MPI::sum<std::uint64_t>(mine.areas.size(), comm);
      mine.first_id = static_cast<types::particle_index>(share(n, comm).first);
      mine.n_global = static_cast<types::particle_index>(n);
      return mine;
    }
  } // namespace

  template <int dim>
  SurfacePatches<dim>
  seed_points_surface(const TissueParameters &parameters,
                      const Founders<dim>    &founders,
                      const MPI_Comm          comm)
  {
    const AllCells<dim> cells = gather(founders, comm);
    SurfacePatches<dim> all;
    on_root(comm, [&]() {
      const ClosedSurface<dim> surface = surface_around(parameters, cells);
      const double             n_by_length =
        std::round(total_area(surface) / std::pow(cells.length, dim - 1));
      for (const SurfacePatch<dim> &patch :
           patches(surface,
                   parameters.boundary_points > 0 ?
                     parameters.boundary_points :
                     static_cast<std::uint64_t>(std::max(1., n_by_length))))
        {
          all.positions.push_back(patch.position);
          all.normals.push_back(patch.normal);
          all.areas.push_back(patch.area);
        }
    });
    return shares(all, comm);
  }

  template SurfacePatches<2>
  seed_points_surface(const TissueParameters &,
                      const Founders<2> &,
                      const MPI_Comm);
  template SurfacePatches<3>
  seed_points_surface(const TissueParameters &,
                      const Founders<3> &,
                      const MPI_Comm);
} // namespace Morula
