// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/key.h>
#include <morula/base/surface_mesh.h>
#include <morula/seeding/closed_surface.h>
#include <morula/seeding/filling.h>
#include <morula/seeding/mesh_patches.h>
#include <morula/seeding/seeding.h>
#include <morula/seeding/shape.h>

#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Moves the vertices to where the filling falls to half, by no more than
     *  3/4 of a cell. */
    template <int dim>
    void
    move_to_half(const AllCells<dim> &cells, ClosedSurface<dim> &surface)
    {
      const Filling<dim> filling(cells);
      const double       half = 0.5 * filling.inside();
      // Newton's method along the gradient of the filling, doc/theory.md (1.9):
      // each step goes to where the linearised filling is half, at most a
      // quarter of a cell. A vertex that has gone 3/4 of a cell is cut off
      // there, so that no vertex leaves the neighbourhood of its cells.
      for (Point<dim> &x : surface.vertices)
        {
          // Newton's method needs a few steps; twenty end it where the filling
          // is too flat to say a place. A slope of 1e-6 a cell's length means
          // that no cell is near.
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
                  // The way is cut to its largest length, in its direction.
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
      // The volume is seen from a point of the surface, so that no digits are
      // lost far from the origin.
      const Point<dim> apex   = surface.vertices.front();
      double           volume = 0.;
      for (std::size_t f = 0; f < surface.facets.size(); ++f)
        volume += (surface.vertices[surface.facets[f][0]] - apex) *
                  facet_vector(surface, f);
      return volume / dim;
    }
  } // namespace


  template <int dim>
  double
  total_area(const ClosedSurface<dim> &surface)
  {
    double area = 0.;
    for (std::size_t f = 0; f < surface.facets.size(); ++f)
      area += facet_vector(surface, f).norm();
    return area;
  }


  namespace
  {
    /** Moves the vertices along the normals, all as far, by no more than a
     *  quarter of a cell, so that the surface encloses the cells' volume. */
    template <int dim>
    void
    match_volume(const AllCells<dim> &cells, ClosedSurface<dim> &surface)
    {
      // The surface moves by the missing volume over its area; curvature makes
      // that inexact, so it is repeated five times. `so_far` bounds the whole
      // way, not one step.
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
          // A vertex moves along the sum of its facets' area vectors.
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
      // 2-D: patches are cut along the line, whose vertices should not be
      // farther apart than half a cell.
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
      // Each segment leads to the next one; where several begin in a vertex,
      // any of them does.
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
      // The vertex before the place, found by bisection, and the part of the
      // segment behind it.
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
          // Each closed line is divided into pieces of equal length, and a
          // patch stands for the chord of a piece. Chords of a closed line add
          // up to 0, so that the area vectors do as well.
          std::vector<double> lengths(1, 0.);
          for (std::size_t i = 0; i < line.size(); ++i)
            lengths.push_back(lengths.back() +
                              line[i].distance(line[(i + 1) % line.size()]));
          // Two chords would enclose nothing.
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
      // A facet's neighbour along an edge is the one that has the same edge the
      // other way round.
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
      return cut_into_patches(triangles, n_wished, true);
    }

    template <int dim>
    std::size_t
    count_parts(const ClosedSurface<dim> &surface)
    {
      // Vertices of one facet belong together; the number of sets is that of
      // the parts.
      boost::disjoint_sets_with_storage<> bodies(surface.vertices.size());
      std::vector<std::size_t>            all(surface.vertices.size());
      std::iota(all.begin(), all.end(), 0);
      for (const auto &facet : surface.facets)
        for (const unsigned int v : facet)
          bodies.union_set(std::size_t(facet[0]), std::size_t(v));
      return bodies.count_sets(all.begin(), all.end());
    }
  } // namespace


  template <int dim>
  ClosedSurface<dim>
  enclose(const AllCells<dim> &cells, const double gap, std::string &misfit)
  {
    // The steps of doc/theory.md, section 1.7: wrap, half of the filling,
    // volume. Lines are cut before their vertices move, so that they can
    // follow the cells.
    ClosedSurface<dim> surface =
      wrap_points(cells.positions, cells.length, gap);
    if constexpr (dim == 2)
      cut_segments(0.5 * cells.length, surface);
    move_to_half(cells, surface);
    match_volume(cells, surface);
    // The text says what the surface is: parts and volume tell overlapping
    // cells from gaps, and a wrong unit shows in either.
    const std::size_t n     = count_parts(surface);
    const double      ratio = enclosed_volume(surface) / cells.volume;
    misfit.clear();
    if (!(ratio > 0.5 && ratio < 2. &&
          (n == 1 || 2 * n <= cells.volumes.size())))
      misfit = "It would have " + std::to_string(n) +
               (n == 1 ? " part" : " parts") + " for " +
               std::to_string(cells.volumes.size()) + " cells and enclose " +
               as_text(ratio) + " of their volume: they " +
               (ratio > 0.5 ? "leave gaps" : "overlap") + '.';
    return surface;
  }


  template <int dim>
  SurfacePatches<dim>
  tiled(const ClosedSurface<dim> &surface, const double n_wished)
  {
    SurfacePatches<dim> all;
    for (const SurfacePatch<dim> &patch : patches(
           surface,
           static_cast<std::uint64_t>(std::max(1., std::round(n_wished)))))
      {
        all.positions.push_back(patch.position);
        all.normals.push_back(patch.normal);
        all.areas.push_back(patch.area);
      }
    all.n_global = all.areas.size();
    return all;
  }


  template <int dim>
  void
  refuse_outside(const Key<std::string>                        &file,
                 const std::vector<Point<dim>>                 &cells,
                 const std::function<bool(const Point<dim> &)> &is_inside)
  {
    std::size_t        n = 0;
    std::ostringstream first;
    // The message names the first of them and says how many there are: that
    // tells a shift from a cell or two that stand astray.
    for (const Point<dim> &x : cells)
      if (!is_inside(x) && n++ == 0)
        first << x;
    if (n > 0)
      file.refuse("a surface in um with all cells of Tissue/Points file "
                  "inside",
                  std::to_string(n) + " of " + std::to_string(cells.size()) +
                    " cells stand outside, the first at (" + first.str() +
                    ") um: do both files have the same origin and unit? Else "
                    "remove these cells, or widen the surface.");
  }


  ClosedSurface<3>
  read_surface(const Key<std::string> &file, const std::vector<Point<3>> &cells)
  {
    const SurfaceMesh mesh(file.path(), file);
    refuse_outside<3>(file, cells, [&mesh](const Point<3> &x) {
      return mesh.contains(x, 0.);
    });
    // Triangles have points, the surface has numbers of vertices: equal
    // coordinates are one vertex.
    ClosedSurface<3>                              surface;
    std::map<std::array<double, 3>, unsigned int> number_of;
    for (const SurfaceTriangle &triangle : mesh.triangles())
      {
        std::array<unsigned int, 3> facet;
        for (unsigned int i = 0; i < 3; ++i)
          {
            const Point<3> &x = triangle.vertices[i];
            const auto [found, is_new] =
              number_of.emplace(std::array<double, 3>{{x[0], x[1], x[2]}},
                                static_cast<unsigned int>(number_of.size()));
            if (is_new)
              surface.vertices.push_back(x);
            facet[i] = found->second;
          }
        surface.facets.push_back(facet);
      }
    return surface;
  }


  MORULA_INSTANTIATE(refuse_outside);
  MORULA_INSTANTIATE(enclose);
  MORULA_INSTANTIATE(tiled);
  MORULA_INSTANTIATE(total_area);
} // namespace Morula
