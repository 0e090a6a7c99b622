// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/surface_mesh.h>
#include <morula/seeding/reviews.h>

#include <deal.II/base/mpi.h>

#include <boost/algorithm/string/join.hpp>

#include <cmath>

namespace Morula
{
  namespace
  {
    /** Usual part of the cells' volume by which that within the surface around
     *  them differs. */
    constexpr double most_off = 0.1;

    /** The same of cells on a lattice, which fits a shape to a percent or so.
     */
    constexpr double most_off_of_lattice = 0.03;

    /** The volume within the surface in units of the founders' volume. */
    template <int dim>
    double
    enclosed_over_cells(const Founders<dim>       &founders,
                        const SurfacePatches<dim> &surface,
                        const MPI_Comm             comm)
    {
      double enclosed = 0., cells = 0.;
      for (std::size_t i = 0; i < surface.areas.size(); ++i)
        // By the divergence theorem the patches give the volume.
        enclosed +=
          surface.areas[i] / dim * (surface.normals[i] * surface.positions[i]);
      for (const double V : founders.volumes)
        cells += V;
      return Utilities::MPI::sum(enclosed, comm) /
             Utilities::MPI::sum(cells, comm);
    }

    /** Lengths of cells, µm: those of bacteria and egg cells lie between. */
    constexpr double shortest_usual = 0.5, longest_usual = 500.;
  } // namespace


  template <int dim>
  void
  review_units(const TissueParameters    &tissue,
               const Founders<dim>       &founders,
               const SurfacePatches<dim> &surface,
               const MPI_Comm             comm,
               Review                    &review)
  {
    // The units of a file are not known, but a length that cells do not have
    // shows; so does a volume within the surface that is not that of the cells.
    // Both are found over all ranks.
    // A column that is not known may be a misspelt one.
    if (!founders.skipped_columns.empty())
      review.warn(TissueKeys::points_file,
                  tissue.points_file,
                  "its columns '" +
                    boost::join(founders.skipped_columns, "', '") +
                    "' say nothing about cells here and are skipped.",
                  "Columns that count are x, y, z, volume, generation, phase "
                  "and type: correct the name of one that is misspelt.");
    double volume = 0.;
    for (const double V : founders.volumes)
      volume += V;
    const double length =
      std::pow(Utilities::MPI::sum(volume, comm) / founders.n_global, 1. / dim);
    if (length < shortest_usual || length > longest_usual)
      review.warn(tissue.cell_spacing.path(),
                  tissue.cell_spacing.text(),
                  "cells are " + as_text(length) +
                    " um long, where 5 to 50 is usual. Is a length in another "
                    "unit than um, such as m, mm or nm?",
                  "Scale places to um and volumes to um^3 (2-D: um^2).");
    if (tissue.is_points() && surface.n_global > 0)
      {
        const double ratio = enclosed_over_cells(founders, surface, comm);
        if (std::abs(ratio - 1.) > most_off)
          review.warn(tissue.points_file.path(),
                      tissue.points_file,
                      "the surface around the cells encloses " +
                        as_text(ratio) +
                        " times their volume: a pressure on it squeezes them "
                        "by so many times that pressure.",
                      "Give each cell its volume in the file, or set "
                      "Tissue/Cell spacing to the length of the cells.");
        if (surface.closed_room > 0.)
          review.warn(tissue.closed_gap.path(),
                      as_text(tissue.closed_gap) + " cell lengths",
                      "the surface around the cells has closed gaps or "
                      "cavities: it encloses about " +
                        as_text(surface.closed_room) +
                        (dim == 3 ? " um^3" : " um^2") +
                        " in which no cell is, and lies closer to the cells "
                        "elsewhere for it.",
                      "Lower this key, or fill the holes, or give the surface "
                      "as a file in Tissue/Points surface.");
      }
    if (!tissue.is_points() && surface.n_global > 0 &&
        tissue.surface_cells == "whole")
      {
        const double ratio = enclosed_over_cells(founders, surface, comm);
        if (std::abs(1. / ratio - 1.) > most_off_of_lattice)
          review.warn(tissue.cell_spacing.path(),
                      as_text(tissue.cell_spacing) + " um",
                      "the lattice does not fit the shape: its cells have " +
                        as_text(1. / ratio) + " of the shape's volume.",
                      "Choose a spacing that divides the shape, a smaller one, "
                      "or Tissue/Surface cells = trimmed.");
      }
    if (tissue.is_mesh())
      review_mesh(TissueKeys::surface_mesh, tissue.surface_mesh, review);
  }


  MORULA_INSTANTIATE(review_units);
} // namespace Morula
