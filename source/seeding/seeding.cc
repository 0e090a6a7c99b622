// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/instantiate.h>
#include <morula/seeding/lattice.h>
#include <morula/seeding/seeding.h>
#include <morula/seeding/shape.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    constexpr std::uint64_t most_ids =
      std::numeric_limits<types::particle_index>::max() - 1;

    /**
     * make_shape() on all ranks, each of which reads a mesh's file; if that
     * fails on one, for instance on a node without the file, all ranks throw.
     */
    template <int dim>
    std::unique_ptr<Shape<dim>>
    make_shape_everywhere(const TissueParameters &parameters,
                          const MPI_Comm          comm)
    {
      std::unique_ptr<Shape<dim>> shape;
      everywhere(comm, [&]() { shape = make_shape<dim>(parameters); });
      return shape;
    }

    /** "It reaches from ... to ... um" */
    template <int dim>
    std::string
    reach(const BoundingBox<dim> &box)
    {
      std::ostringstream text;
      text << "It reaches from (" << box.get_boundary_points().first << ") to ("
           << box.get_boundary_points().second << ") um";
      return text.str();
    }

    /** Refuses a mesh that exceeds the limits. */
    template <int dim>
    void
    check_extent(const TissueParameters   &parameters,
                 const Shape<dim>         &shape,
                 const SeedingLimits<dim> &limits)
    {
      const BoundingBox<dim> box = shape.bounding_box();
      for (unsigned int d = 0; d < dim; ++d)
        if (!(std::max(std::abs(box.lower_bound(d)),
                       std::abs(box.upper_bound(d))) <= limits.farthest))
          parameters.surface_mesh.refuse(
            "a surface at most " + as_text(limits.farthest) +
              " um from the origin (a number of times Grid/Spacing)",
            reach(box) + ": move the scene nearer to the origin.");
      if (limits.check_memory)
        limits.check_memory(box,
                            shape.volume() /
                              std::pow(parameters.cell_spacing.value(), dim),
                            shape.volume());
    }

    /** Numbers this rank's founders, after those of the lower ranks. */
    template <int dim>
    void
    number_founders(Founders<dim>          &founders,
                    const TissueParameters &parameters,
                    const BoundingBox<dim> &box,
                    const MPI_Comm          comm)
    {
      const std::uint64_t n_mine = founders.positions.size();
      std::uint64_t       below  = 0;
      const int           error =
        MPI_Exscan(&n_mine, &below, 1, MPI_UINT64_T, MPI_SUM, comm);
      AssertThrowMPI(error);
      if (Utilities::MPI::this_mpi_process(comm) == 0)
        below = 0; // MPI_Exscan() leaves it undefined

      const std::uint64_t n = Utilities::MPI::sum(n_mine, comm);
      if (n == 0 && parameters.is_mesh())
        parameters.surface_mesh.refuse(
          "a surface in um with at least one cell's centre inside",
          reach(box) + ". If the file is in another unit, scale it to um, such "
                       "as by 1000 from mm or 1e6 from m; else choose another "
                       "Cell spacing or Lattice offset.");
      if (n == 0)
        throw_no_cell_fits(parameters);
      founders.first_id = static_cast<types::particle_index>(below);
      founders.n_global = static_cast<types::particle_index>(n);
    }
  } // namespace

  template <int dim>
  Founders<dim>
  seed_founders(const TissueParameters   &parameters,
                const MPI_Comm            comm,
                const SeedingLimits<dim> &limits)
  {
    // Cells of a file need no lattice. Otherwise each rank looks at an equal
    // share of the lattice's sites, in order, and keeps those inside of the
    // shape. Trimming changes volumes and places, but not which sites are
    // occupied; it looks at neighbouring sites itself, so nothing is exchanged.
    // If it fails on any rank all ranks refuse the scene. At last the founders
    // get ids over all ranks, in the order of the sites.
    const double volume = std::pow(parameters.cell_spacing.value(), dim);
    if (parameters.is_points())
      return read_points<dim>(parameters.points_file, volume, comm, limits);

    const std::unique_ptr<Shape<dim>> shape =
      make_shape_everywhere<dim>(parameters, comm);
    if (parameters.is_mesh())
      check_extent(parameters, *shape, limits);
    const Lattice<dim> lattice(parameters, shape->bounding_box());
    const auto [begin, end] = share(lattice.n_sites(), comm);

    Founders<dim>              founders;
    std::vector<std::uint64_t> sites;
    for (std::uint64_t site = begin; site < end; ++site)
      {
        const Point<dim> x = lattice.position(site);
        if (!lattice.is_occupied(*shape, x))
          continue;
        founders.positions.push_back(x);
        sites.push_back(site);
      }
    founders.volumes.assign(founders.positions.size(), volume);
    // trim() is called only where it is asked for.
    const bool seeded = parameters.surface_cells == "whole" ||
                        trim(lattice, *shape, sites, founders);
    if (Utilities::MPI::min(seeded ? 1 : 0, comm) == 0)
      parameters.surface_cells.refuse(
        "'whole' where the tissue is much thinner than a cell",
        "Choose 'whole' or a smaller Cell spacing.");
    number_founders(founders, parameters, shape->bounding_box(), comm);
    return founders;
  }

  template <int dim>
  SurfacePatches<dim>
  seed_surface(const TissueParameters &parameters, const MPI_Comm comm)
  {
    // The number of patches is the scene's, or that of cells' faces in the
    // area. The tiling knows each patch by its number, so that each rank makes
    // its own share alone, and no rank holds the surface as a whole.
    SurfacePatches<dim> patches;
    if (parameters.is_points())
      return patches;

    const std::unique_ptr<Shape<dim>> shape =
      make_shape_everywhere<dim>(parameters, comm);
    const double n_by_spacing =
      std::max(1.,
               std::round(shape->surface_area() /
                          std::pow(parameters.cell_spacing.value(), dim - 1)));
    const bool chosen = parameters.boundary_points > 0;
    if (!chosen && !(n_by_spacing < most_ids))
      parameters.cell_spacing.refuse(
        "a spacing in um that gives fewer than 4e9 boundary points",
        "Choose a larger spacing, or set Boundary points.");
    const SurfaceTiling<dim> tiling =
      shape->tile(chosen ? parameters.boundary_points :
                           static_cast<std::uint64_t>(n_by_spacing));

    const auto [begin, end] = share(tiling.n_patches, comm);
    patches.first_id        = static_cast<types::particle_index>(begin);
    patches.n_global = static_cast<types::particle_index>(tiling.n_patches);
    for (std::uint64_t i = begin; i < end; ++i)
      patches.add(tiling.patch(i));
    return patches;
  }

  MORULA_INSTANTIATE(seed_founders);
  MORULA_INSTANTIATE(seed_surface);
} // namespace Morula
