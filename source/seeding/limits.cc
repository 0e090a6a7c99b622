// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/seeding/limits.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Morula
{
  namespace
  {
    void
    refuse_long(const AnyKey &key,
                const double  length,
                const double  value,
                const double  h)
    {
      // Lengths that are negative or no numbers are refused elsewhere.
      if (length > longest_tissue * h)
        throw InputError(key.path(),
                         as_text(value),
                         "tissue at most " + as_text(longest_tissue) +
                           " times Grid/Spacing long, " +
                           as_text(longest_tissue * h) + " um",
                         "Choose a smaller tissue, or a larger Grid/Spacing.");
    }

    /** Grid cells of the box that is put around tissue of this extent. */
    template <int dim>
    double
    grid_cells(const BoundingBox<dim> &box, const double h)
    {
      double n = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          // The padding is that of BackgroundGrid::enclose().
          const double of_tissue = std::floor(box.side_length(d) / h) + 1.;
          n *= of_tissue + 2. * (2. + std::floor(of_tissue / 8.));
        }
      return n;
    }

    /** Refuses tissue that fills next to nothing of the grid around it. */
    template <int dim>
    void
    check_filled(const TissueParameters &tissue,
                 const double            h,
                 const BoundingBox<dim> &box,
                 const double            cells,
                 const double            volume)
    {
      // A thousand grid cells for each one with tissue are much more than any
      // real scene has: two spheroids with a gap of many diameters are far from
      // that.
      constexpr double most_per_cell = 1000., few_cells = 1000.;
      const double     n = grid_cells(box, h);
      if (n <= most_per_cell *
                 std::max({few_cells, cells, volume / std::pow(h, dim)}))
        return;
      const bool              is_mesh = tissue.is_mesh();
      const Key<std::string> &file =
        is_mesh ? tissue.surface_mesh : tissue.points_file;
      std::ostringstream remedy;
      remedy << "It reaches from (" << box.get_boundary_points().first
             << ") to (" << box.get_boundary_points().second << ") um, " << n
             << " grid cells of " << h << " um, for some " << std::round(cells)
             << " cells: correct the " << (is_mesh ? "vertex" : "cell")
             << " that lies astray, or raise Grid/Spacing. If the file is in "
                "another unit, scale it to um.";
      file.refuse("tissue that fills a part of the grid around it",
                  remedy.str());
    }
  } // namespace


  void
  check_lengths(const TissueParameters &tissue,
                const double            h,
                const unsigned int      dim)
  {
    // Points have volumes of their own, which are tested as they are read.
    if (!tissue.is_points() && tissue.cell_spacing > longest_cell * h)
      tissue.cell_spacing.refuse(
        "a spacing of at most " + as_text(longest_cell) +
          " times Grid/Spacing, " + as_text(longest_cell * h) + " um",
        "Choose a smaller spacing, or a larger Grid/Spacing: a "
        "cell deforms as a whole.");
    if (tissue.has_radius())
      refuse_long(tissue.radius, 2. * tissue.radius, tissue.radius, h);
    for (unsigned int d = 0;
         d < std::min<std::size_t>(dim, tissue.size->size());
         ++d)
      if (tissue.has_size(d))
        refuse_long(tissue.size,
                    tissue.size.value()[d],
                    tissue.size.value()[d],
                    h);
  }


  template <int dim>
  SeedingLimits<dim>
  seeding_limits(const TissueParameters &tissue,
                 const double            h,
                 const MemoryCheck      &check_memory)
  {
    SeedingLimits<dim> limits;
    limits.farthest    = farthest_place * h;
    limits.extent      = longest_tissue * h;
    limits.cell_length = longest_cell * h;
    // The parameters are copied, since the check is called later, while the
    // cells are made or read.
    limits.check_memory = [tissue, h, check_memory](const BoundingBox<dim> &box,
                                                    const double cells,
                                                    const double volume) {
      check_filled(tissue, h, box, cells, volume);
      check_memory(cells, volume, grid_cells(box, h));
    };
    return limits;
  }


  template SeedingLimits<2>
  seeding_limits(const TissueParameters &, const double, const MemoryCheck &);
  template SeedingLimits<3>
  seeding_limits(const TissueParameters &, const double, const MemoryCheck &);
} // namespace Morula
