// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/seeding/bodies.h>
#include <morula/seeding/closed_surface.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>

namespace Morula
{
  namespace
  {
    /** The place at @p way, um, along a closed line; lengths[i] is the way from
     *  its begin to its point i. */
    Point<2>
    place_along(const std::vector<Point<2>> &line,
                const std::vector<double>   &lengths,
                const double                 way)
    {
      // The point before the place, found by bisection, and the part of the
      // segment behind it.
      const std::size_t i =
        std::min<std::size_t>(std::upper_bound(lengths.begin(),
                                               lengths.end(),
                                               way) -
                                lengths.begin(),
                              line.size() - 1) -
        1;
      const double part =
        std::clamp((way - lengths[i]) / (lengths[i + 1] - lengths[i]), 0., 1.);
      return line[i] + part * (line[i + 1] - line[i]);
    }
  } // namespace


  std::vector<SurfacePatch<2>>
  cut_into_patches(const std::vector<std::vector<Point<2>>> &lines,
                   const double                              length)
  {
    std::vector<SurfacePatch<2>> all;
    for (const std::vector<Point<2>> &line : lines)
      {
        // Each closed line is divided into pieces of equal length, and a patch
        // stands for the chord of a piece. Chords of a closed line add up to 0,
        // so that the area vectors do as well.
        std::vector<double> lengths(1, 0.);
        for (std::size_t i = 1; i < line.size(); ++i)
          lengths.push_back(lengths.back() + line[i].distance(line[i - 1]));
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


  template <int dim>
  double
  n_patches(const Key<std::string>                        &file,
            const Founders<dim>                           &founders,
            const std::function<bool(const Point<dim> &)> &is_inside,
            const double                                   area,
            const double                                   n_wished,
            const MPI_Comm                                 comm)
  {
    // The message names the first cell outside and says how many there are:
    // that tells a shift from a cell or two that stand astray.
    std::vector<Point<dim>> outside;
    std::copy_if(founders.positions.begin(),
                 founders.positions.end(),
                 std::back_inserter(outside),
                 [&](const Point<dim> &x) { return !is_inside(x); });
    outside = of_all_ranks(outside, comm);
    if (!outside.empty())
      {
        std::ostringstream first;
        first << outside[0];
        file.refuse("a surface in um with all cells of Tissue/Points file "
                    "inside",
                    std::to_string(outside.size()) + " of " +
                      std::to_string(founders.n_global) +
                      " cells stand outside, the first at (" + first.str() +
                      ") um: do both files have the same origin and unit? Else "
                      "remove these cells, or widen the surface.");
      }
    if (n_wished > 0.)
      return n_wished;
    const std::vector<double> volumes = of_all_ranks(founders.volumes, comm);
    const double              length =
      std::pow(std::accumulate(volumes.begin(), volumes.end(), 0.) /
                 volumes.size(),
               1. / dim);
    return std::max(1., std::round(area / std::pow(length, dim - 1)));
  }


  std::vector<SurfacePatch<3>>
  patches_of_file(const Key<std::string> &file,
                  const Founders<3>      &founders,
                  const double            n_wished,
                  const MPI_Comm          comm)
  {
    std::optional<SurfaceMesh> mesh;
    everywhere(comm, [&]() { mesh.emplace(file.path(), file); });
    double area = 0.;
    for (const SurfaceTriangle &triangle : mesh->triangles())
      area += area_vector(triangle.vertices).norm();
    const double n = n_patches<3>(
      file,
      founders,
      [&](const Point<3> &x) { return mesh->contains(x, 0.); },
      area,
      n_wished,
      comm);
    return cut_into_patches(mesh->triangles(), std::uint64_t(n), true);
  }


  MORULA_INSTANTIATE(n_patches);
} // namespace Morula
