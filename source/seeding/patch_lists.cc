// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/share.h>
#include <morula/seeding/patch_lists.h>

#include <deal.II/base/mpi.h>

#include <boost/serialization/vector.hpp>

#include <algorithm>

namespace Morula
{
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
    const unsigned int n = *std::max_element(bodies.begin(), bodies.end()) + 1;
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

  MORULA_INSTANTIATE(cells_of_bodies);
  MORULA_INSTANTIATE(append_patches);
  MORULA_INSTANTIATE(shares_of);
} // namespace Morula
