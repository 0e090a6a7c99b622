// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/base/instantiate.h>
#include <morula/scene/size.h>
#include <morula/seeding/seeding.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/mpi.h>

#include <unistd.h>

#include <cmath>
#include <sstream>

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

    /** Bytes of a run of this size at t = 0, on all ranks together: measured,
     *  right within a factor of about two. */
    double
    memory_of(const Scene &scene, const SceneSize &size)
    {
      // A compact tissue is a cube that is covered by splines: its edge in grid
      // spacings plus two, as quadratic B-splines reach out by one on either
      // side. A row couples with 5^dim splines, at 12 bytes an entry, for the
      // matrix, the preconditioner and the places of entries; a direct solver
      // has its factors, by nested dissection. A cell has about 70 numbers.
      const double dim = scene.dimension;
      const double equations =
        dim *
        std::pow(std::pow(size.volume, 1. / dim) / scene.grid.spacing + 2.,
                 dim);
      const double row = 2.6 * 12. * dim * std::pow(5., dim);
      const double factors =
        scene.solver.linear_solver != "direct" ? 0. :
        dim == 2. ? 370. * equations * std::log(equations) :
                    1000. * std::pow(equations, 4. / 3.);
      constexpr double program = 180e6, cell = 1800.;
      return program + (size.cells + scene.tissue.boundary_points) * cell +
             equations * row + factors;
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
    const double needed = memory_of(scene, size) + grid_cell * size.grid_cells;
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
                         "Tissue/Boundary points, or use more machines. Check "
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


  template SeedingLimits<2>
  seeding_limits(const Scene &, const MPI_Comm);
  template SeedingLimits<3>
  seeding_limits(const Scene &, const MPI_Comm);
} // namespace Morula
