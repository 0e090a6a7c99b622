// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/particles/point_exchange.h>
#include <morula/particles/point_store.h>
#include <morula/seeding/bodies.h>
#include <morula/seeding/closed_surface.h>
#include <morula/surface/cell_surface.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>
#include <utility>

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
                      " cells lie outside, the first at (" + first.str() +
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


  namespace
  {
    /** The surface around the cells of a body. */
    template <int dim>
    struct SurfaceOfBody
    {
      CellSurface<dim> surface;
      /** All ranks' patches in their order, with their area vectors. */
      PointList<dim> patches;
      double         volume = 0.; // of the cells, µm^dim
      /** Of all ranks' cells, and those not behind the patch that is nearest to
       *  them. */
      std::uint64_t n_cells = 0, n_outside = 0;

      /** Makes the surface on the lattice of a grid of this rank's cells.
       *  Collective. */
      SurfaceOfBody(const PointList<dim> &cells,
                    const GridParameters &parameters,
                    const MPI_Comm        comm)
        : patches(dim)
      {
        volume  = sum_of_all_ranks(cells.numbers, comm);
        n_cells = Utilities::MPI::sum(std::uint64_t(cells.size()), comm);
        if (n_cells == 0)
          return;
        // The tissue has no grid yet, so the body gets one of its own.
        BackgroundGrid<dim> grid(parameters, comm);
        const auto [first, last] = extent<dim>({&cells.positions}, grid);
        grid.enclose(first, last);
        grid.partition(count_points(cells.positions, grid));
        surface = surface_of_cells(send_to_owners(cells, grid), grid);
        for (std::size_t k = 0; k < surface.places.size(); ++k)
          patches.add_value(surface.places[k],
                            surface.positions[k],
                            surface.areas[k]);
        patches = of_all_ranks(patches, comm);

        const NearTree<dim> tree(patches.positions);
        std::uint64_t       n = 0;
        for (const Point<dim> &x : cells.positions)
          if (const auto k = tree.nearest(x, [](const auto) { return true; });
              !k || (x - patches.positions[*k]) * area(*k) > 0.)
            ++n;
        n_outside = Utilities::MPI::sum(n, comm);
      }

      /** The area vector of a patch, µm^(dim-1). */
      Tensor<1, dim>
      area(const std::size_t k) const
      {
        return patches.template value<Tensor<1, dim>>(k);
      }

      /** Refuses a surface that is not around the cells: if half of them are
       *  outside, if it has more parts than half of them, or encloses less than
       *  half of their volume. @throws InputError */
      void
      check(const TissueParameters &parameters) const
      {
        // Where cells leave gaps, the surface is around each of them, or around
        // some of them, whose neighbourhood has room for the volumes of all.
        // Where they overlap, it cannot be so far from them as their volumes
        // demand.
        const double       ratio = surface.volume / volume;
        const unsigned int n     = surface.n_parts;
        const bool         is_around =
          n > 0 && 2 * n_outside <= n_cells && (n == 1 || 2 * n <= n_cells);
        if (n_cells > 0 && !(is_around && ratio > 0.5))
          parameters.points_file.refuse(
            "cells side by side, as there is a surface around them "
            "(Tissue/Points surface = " +
              parameters.points_surface + ')',
            "It would have " + std::to_string(n) +
              (n == 1 ? " part" : " parts") + " for " +
              std::to_string(n_cells) + " cells, of which " +
              std::to_string(n_outside) + " are outside, and enclose " +
              as_text(ratio) + " of their volume: they " +
              (is_around ? "overlap" : "leave gaps") +
              ". If the file is in another unit, scale it to um; else give "
              "each cell its volume, or set Tissue/Cell spacing to their "
              "length; or set Points surface = none.");
      }
    };

    /** All ranks' patches of the surfaces around the cells of each body, on the
     *  lattice of a grid of the spacing @p h (µm). Collective.
     *  @throws InputError if there is none around all of them */
    template <int dim>
    SurfacePatches<dim>
    patches_around(const TissueParameters &parameters,
                   const GridParameters   &grid,
                   const Founders<dim>    &founders,
                   const double            h,
                   const MPI_Comm          comm)
    {
      // All cells are one body if founders do not know theirs. A type of cells
      // may have no founder.
      const unsigned int          n = number_of_bodies(founders, comm);
      const bool                  know_bodies = n > 0;
      std::vector<PointList<dim>> bodies(std::max(1u, n), PointList<dim>(1));
      for (std::size_t i = 0; i < founders.positions.size(); ++i)
        bodies[know_bodies ? founders.bodies[i] : 0].add_value(
          founders.first_id + i, founders.positions[i], founders.volumes[i]);
      SurfacePatches<dim> all;
      std::vector<double> volumes;
      for (unsigned int b = 0; b < bodies.size(); ++b)
        {
          GridParameters lattice;
          lattice.spacing = h;
          lattice.offset  = grid.offset.value();
          // A surface that stays is not coarser than the cells, unless it is
          // wished. Bodies that touch may be thinner than the lattice resolves.
          // Then it becomes finer, down to half a cell.
          SurfaceOfBody<dim> body(bodies[b], lattice, comm);
          if (const double fine = 2.5 * body.surface.cell_length;
              parameters.boundary_points == 0 && fine < h)
            {
              lattice.spacing = fine;
              body            = SurfaceOfBody<dim>(bodies[b], lattice, comm);
            }
          while (know_bodies && body.n_outside > 0.1 * body.n_cells &&
                 lattice.spacing > 2. * body.surface.cell_length)
            {
              lattice.spacing = 0.5 * lattice.spacing;
              body            = SurfaceOfBody<dim>(bodies[b], lattice, comm);
            }
          body.check(parameters);
          all.filled += body.surface.filled;
          all.n_outside += body.n_outside;
          volumes.push_back(body.surface.volume);
          // What tiny patches would have added to the sum of the area vectors
          // is shared out among those that there are.
          Tensor<1, dim> opening;
          for (std::size_t k = 0; k < body.patches.size(); ++k)
            opening += body.area(k) / body.surface.area;
          for (std::size_t k = 0; k < body.patches.size(); ++k)
            {
              const Tensor<1, dim> A =
                body.area(k) - body.area(k).norm() * opening;
              all.add({body.patches.positions[k], A / A.norm(), A.norm()});
            }
          if (know_bodies)
            all.bodies.resize(all.areas.size(), b);
        }
      if (know_bodies)
        part_bodies(volumes, all);
      return all;
    }
  } // namespace

  template <int dim>
  SurfacePatches<dim>
  seed_points_surface(const TissueParameters &parameters,
                      const GridParameters   &grid,
                      const Founders<dim>    &founders,
                      const MPI_Comm          comm)
  {
    // All ranks get all patches, as surfaces are small beside the tissue, and
    // keep their shares. The number of patches goes with the edge of the
    // lattice to the power of 1 - dim, but also depends on where lines and
    // nodes are. So each try for a wished number corrects the lattice of the
    // one before, and the best one counts.
    const double        n = parameters.boundary_points;
    double              h = grid.spacing, least = 0.;
    SurfacePatches<dim> mine;
    if (parameters.has_surface_file())
      for (const auto &patch :
           patches_of_file(parameters.points_surface, founders, n, comm))
        mine.add(patch);
    else
      for (unsigned int i = 0; i < (n > 0. ? 6 : 1); ++i)
        {
          SurfacePatches<dim> all =
            patches_around(parameters, grid, founders, h, comm);
          const double ratio = all.areas.size() / n;
          if (i == 0 || std::abs(std::log(ratio)) < least)
            {
              mine  = std::move(all);
              least = std::abs(std::log(ratio));
            }
          h *= std::pow(ratio, (i == 0 ? 1. : 0.5) / (dim - 1));
        }

    const auto [begin, end] = share(mine.areas.size(), comm);
    const auto keep_share   = [begin = begin, end = end](auto &list) {
      if (!list.empty())
        list = {list.begin() + begin, list.begin() + end};
    };
    mine.first_id = begin;
    mine.n_global = mine.areas.size();
    keep_share(mine.positions);
    keep_share(mine.normals);
    keep_share(mine.areas);
    keep_share(mine.bodies);
    return mine;
  }

  MORULA_INSTANTIATE(seed_points_surface);
} // namespace Morula
