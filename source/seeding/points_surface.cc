// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/seeding/bodies.h>
#include <morula/seeding/closed_surface.h>
#include <morula/seeding/filling.h>
#include <morula/seeding/points_surface.h>

#include <deal.II/base/mpi.h>

#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

namespace Morula
{
  namespace
  {
    /** The surface around cells, which are refused if they have no common one.
     */
    template <int dim>
    ClosedSurface<dim>
    checked_surface(const TissueParameters &parameters,
                    const AllCells<dim>    &cells)
    {
      std::string        misfit;
      ClosedSurface<dim> surface =
        enclose(cells, parameters.closed_gap, misfit);
      if (misfit.empty())
        return surface;
      parameters.points_file.refuse(
        "cells side by side, as there is a surface around them (Tissue/Points "
        "surface = " +
          parameters.points_surface + ')',
        misfit +
          " If the file is in another unit, scale it to um; else give each "
          "cell its volume, or set Tissue/Cell spacing to their length; or set "
          "Points surface = none.");
    }

    /** Moves the patches along their normals, all as far, so that they enclose
     *  this volume, µm^dim. */
    template <int dim>
    void
    enclose_exactly(const double volume, SurfacePatches<dim> &patches)
    {
      // The volume as in enclosed_volume(), from the patches. A shift by w
      // along all normals changes it by w/dim times their area: positions move,
      // areas and normals stay.
      const Point<dim> apex   = patches.positions.front();
      double           so_far = 0., area = 0.;
      for (std::size_t i = 0; i < patches.areas.size(); ++i)
        {
          so_far += patches.areas[i] / dim *
                    ((patches.positions[i] - apex) * patches.normals[i]);
          area += patches.areas[i];
        }
      const double way = dim * (volume - so_far) / area;
      for (std::size_t i = 0; i < patches.areas.size(); ++i)
        patches.positions[i] += way * patches.normals[i];
    }

    /** The cells of all ranks, on rank 0, body by body: those of one body if
     *  founders do not know theirs. Collective. */
    template <int dim>
    std::vector<AllCells<dim>>
    cells_of_bodies(const Founders<dim> &founders, const MPI_Comm comm)
    {
      // Each list arrives in the order of the ranks, so that positions, volumes
      // and bodies stay in step.
      std::vector<Point<dim>>   positions;
      std::vector<double>       volumes;
      std::vector<unsigned int> bodies;
      for (const auto &part : Utilities::MPI::gather(comm, founders.positions))
        positions.insert(positions.end(), part.begin(), part.end());
      for (const auto &part : Utilities::MPI::gather(comm, founders.volumes))
        volumes.insert(volumes.end(), part.begin(), part.end());
      for (const auto &part : Utilities::MPI::gather(comm, founders.bodies))
        bodies.insert(bodies.end(), part.begin(), part.end());
      if (bodies.empty())
        return {AllCells<dim>(positions, volumes)};
      const unsigned int n =
        *std::max_element(bodies.begin(), bodies.end()) + 1;
      std::vector<std::vector<Point<dim>>> places(n);
      std::vector<std::vector<double>>     sizes(n);
      for (std::size_t i = 0; i < bodies.size(); ++i)
        {
          places[bodies[i]].push_back(positions[i]);
          sizes[bodies[i]].push_back(volumes[i]);
        }
      std::vector<AllCells<dim>> list;
      for (unsigned int b = 0; b < n; ++b)
        list.emplace_back(places[b], sizes[b]);
      return list;
    }

    /** Adds the patches of one body to those of all. @param body its number, if
     *  bodies are told apart */
    template <int dim>
    void
    append_patches(const SurfacePatches<dim>         &more,
                   const std::optional<unsigned int> &body,
                   SurfacePatches<dim>               &all)
    {
      all.positions.insert(all.positions.end(),
                           more.positions.begin(),
                           more.positions.end());
      all.normals.insert(all.normals.end(),
                         more.normals.begin(),
                         more.normals.end());
      all.areas.insert(all.areas.end(), more.areas.begin(), more.areas.end());
      if (body)
        all.bodies.insert(all.bodies.end(), more.positions.size(), *body);
      all.n_global += more.n_global;
    }

    /** This rank's share of the patches that rank 0 has. Collective. */
    template <int dim>
    SurfacePatches<dim>
    shares_of(const SurfacePatches<dim> &all, const MPI_Comm comm)
    {
      // Rank 0 sends the whole list to all, and each takes its share. Surfaces
      // are small beside the tissue.
      const auto take = [comm](const auto &list, auto &mine) {
        const auto everything   = Utilities::MPI::broadcast(comm, list, 0);
        const auto [begin, end] = share(everything.size(), comm);
        mine.assign(everything.begin() + begin, everything.begin() + end);
      };
      SurfacePatches<dim> mine;
      take(all.positions, mine.positions);
      take(all.normals, mine.normals);
      take(all.areas, mine.areas);
      take(all.bodies, mine.bodies);
      mine.closed_room = Utilities::MPI::broadcast(comm, all.closed_room, 0);
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
    // Rank 0 has all cells and makes the surface; the shares go to all ranks.
    // Without a number in the scene there is about one patch for the face of a
    // cell.
    const std::vector<AllCells<dim>> bodies = cells_of_bodies(founders, comm);
    const bool                       know_bodies =
      Utilities::MPI::logical_or(!founders.bodies.empty(), comm);
    SurfacePatches<dim> all;
    on_root(comm, [&]() {
      std::vector<ClosedSurface<dim>> surfaces;
      double                          area = 0.;
      // A type of cells may have no founder.
      for (const AllCells<dim> &cells : bodies)
        {
          surfaces.emplace_back();
          if (cells.positions.empty() && know_bodies)
            continue;
          surfaces.back() =
            (parameters.has_surface_file() ?
               read_surface(parameters.points_surface, cells.positions) :
               checked_surface(parameters, cells));
          area += total_area(surfaces.back());
        }
      double closed = 0.;
      for (unsigned int b = 0; b < bodies.size(); ++b)
        {
          if (surfaces[b].facets.empty())
            continue;
          const double of_body = total_area(surfaces[b]);
          append_patches(
            tiled(surfaces[b],
                  parameters.boundary_points > 0 ?
                    std::ceil(parameters.boundary_points * of_body / area) :
                    of_body / std::pow(bodies[b].length, dim - 1)),
            know_bodies ? std::optional<unsigned int>(b) : std::nullopt,
            all);
          // A surface from a file closes what its author has meant.
          if (!parameters.has_surface_file())
            closed += room_without_cells(bodies[b], all);
        }
      all.closed_room = closed;
      if (know_bodies)
        part_bodies(all);
    });
    return shares_of(all, comm);
  }

  template <int dim>
  std::optional<SurfacePatches<dim>>
  surface_around(const std::vector<Point<dim>> &positions,
                 const std::vector<double>     &volumes,
                 const SurfaceWish             &wish)
  {
    // Called on one rank, with all cells: so there is nothing to exchange, and
    // the result is the same for any number of ranks.
    std::string              misfit;
    const ClosedSurface<dim> surface =
      enclose(AllCells<dim>(positions, volumes, wish.length), wish.gap, misfit);
    if (!misfit.empty())
      return {};
    SurfacePatches<dim> patches =
      tiled(surface, total_area(surface) / wish.patch_area);
    if (wish.volume > 0.)
      enclose_exactly(wish.volume, patches);
    return patches;
  }

  MORULA_INSTANTIATE(seed_points_surface);
  MORULA_INSTANTIATE(surface_around);
} // namespace Morula
