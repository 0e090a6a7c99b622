// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/scene/estimates.h>
#include <morula/scene/size.h>
#include <morula/seeding/limits.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/mpi.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

namespace Morula
{
  namespace
  {
    std::string
    gigabytes(const double bytes)
    {
      std::ostringstream out;
      out.precision(3);
      out << bytes / 1e9 << " GB";
      return out.str();
    }
  } // namespace


  SceneSize
  initial_size(const Scene &scene)
  {
    // This is known without seeding a cell, so scenes that are far too large
    // are refused before their cells are made. A file has its cells already.
    if (scene.tissue.is_from_file())
      return {};
    const double volume = scene.dimension == 2 ?
                            make_shape<2>(scene.tissue)->volume() :
                            make_shape<3>(scene.tissue)->volume();
    return {volume / std::pow(scene.tissue.cell_spacing.value(),
                              scene.dimension.value()),
            volume};
  }


  template <int dim>
  SceneSize
  expected_size(const Scene                   &scene,
                const std::vector<Point<dim>> &founders,
                const MPI_Comm                 comm)
  {
    // The loop is over the founders of this rank. Each stands for its
    // descendants at the end, if no death is in the scene, and for the growth
    // of its law. Sums are those of all ranks.
    const double t = scene.time.end_time;
    const double V = std::pow(scene.tissue.cell_spacing.value(), dim);
    const SceneEffects<dim>     effects = effects_of<dim>(scene);
    const GrowthLaw<dim> *const law     = effects.development.law.get();
    // Cells that divide when they have grown share the volume that the law
    // gives them. Others have as much as a founder each; the number of cells
    // that die is known only in the run, and then these divisions are not
    // counted either.
    const auto &fates = effects.development.fates;
    const bool  mortal =
      std::any_of(fates.begin(), fates.end(), [](const auto &fate) {
        return fate->is_deadly();
      });
    std::vector<ExpectedCells<dim>> in_volume, of_own_volume;
    for (const auto &fate : fates)
      if (auto expected = fate->expected_cells(t);
          expected && (fate->follows_growth() || !mortal))
        (fate->follows_growth() ? in_volume : of_own_volume)
          .push_back(std::move(expected));
    SceneSize size;
    for (const Point<dim> &X : founders)
      {
        const double ratio = law ? law->expected_volume_ratio(X, t) : 1.;
        double       n = 1., n_of_volume = 1.;
        for (const auto &expected : of_own_volume)
          n *= expected(X, V * ratio);
        for (const auto &expected : in_volume)
          n_of_volume *= expected(X, V * ratio);
        size.cells += n * n_of_volume;
        size.volume += n * V * ratio;
      }
    size.cells  = Utilities::MPI::sum(size.cells, comm);
    size.volume = Utilities::MPI::sum(size.volume, comm);

    // A run stops when it has the wished number of cells, after a step that may
    // at most double it.
    const double limit =
      std::max(2. * scene.time.stop_at_cells,
               Utilities::MPI::sum(1. * founders.size(), comm));
    if (scene.time.stop_at_cells > 0 && size.cells > limit)
      size = {limit, size.volume * limit / size.cells};
    return size;
  }


  double
  physical_memory(const MPI_Comm comm)
  {
    // Ranks of one machine share its memory, so only the first of each counts
    // it. The split is collective.
    MPI_Comm machine;
    MPI_Comm_split_type(comm, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
    const bool first = Utilities::MPI::this_mpi_process(machine) == 0;
    MPI_Comm_free(&machine);
    const double mine = 1. * sysconf(_SC_PHYS_PAGES) * sysconf(_SC_PAGESIZE);
    return Utilities::MPI::sum(first ? mine : 0., comm);
  }


  void
  check_memory(const Scene &scene, const SceneSize &size, const MPI_Comm comm)
  {
    // The bytes of a grid cell are measured: 430 in 2-D and 700 in 3-D for a
    // triangulation with the tables of one rank. Windows of several ranks
    // overlap, which takes 100 more.
    const double grid_cell =
      (scene.dimension == 2 ? 330. : 600.) +
      (Utilities::MPI::n_mpi_processes(comm) > 1 ? 200. : 100.);
    const double needed =
      estimated_memory(scene, size) + grid_cell * size.grid_cells;
    const double available = physical_memory(comm);
    if (!(needed <= available))
      {
        std::ostringstream value;
        value << size.cells << " cells of " << scene.tissue.cell_spacing
              << " um on a grid of " << scene.grid.spacing << " um";
        if (size.grid_cells > 0.)
          value << ", " << size.grid_cells << " grid cells around them";
        throw InputError("The scene",
                         value.str() + ", about " + gigabytes(needed),
                         "at most the " + gigabytes(available) +
                           " of memory here",
                         "Raise Tissue/Cell spacing or Grid/Spacing, lower "
                         "Tissue/Boundary points, shorten Time/End time, set "
                         "Time/Stop at cells, or use more machines. Check "
                         "that files are in um.");
      }
  }


  template <int dim>
  SeedingLimits<dim>
  seeding_limits(const Scene &scene, const MPI_Comm comm)
  {
    // Seeding calls the function when it knows how many cells and grid cells
    // there would be, before it makes them. The scene is copied into it, as the
    // function may outlive it.
    SeedingLimits<dim> limits = seeding_limits<dim>(
      scene.tissue,
      scene.grid.spacing,
      [scene,
       comm](const double cells, const double volume, const double grid_cells) {
        check_memory(scene, {cells, volume, grid_cells}, comm);
      });
    limits.types = scene.type_names();
    return limits;
  }


  MORULA_INSTANTIATE(expected_size);
  template SeedingLimits<2>
  seeding_limits(const Scene &, const MPI_Comm);
  template SeedingLimits<3>
  seeding_limits(const Scene &, const MPI_Comm);
} // namespace Morula
