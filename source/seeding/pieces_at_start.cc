// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/seeding/bodies.h>
#include <morula/seeding/pieces_at_start.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/pending/disjoint_sets.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace Morula
{
  namespace
  {
    /** A grid cell by its place, and the body in it. */
    template <int dim>
    using GridPlace = std::array<int, dim + 1>;

    /** The places of points, in their order. */
    template <int dim>
    std::vector<GridPlace<dim>>
    places_of(const GridParameters            &grid,
              const std::vector<Point<dim>>   &points,
              const std::vector<unsigned int> &bodies)
    {
      const std::vector<double>   offset = grid.offset;
      std::vector<GridPlace<dim>> places(points.size());
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          for (unsigned int d = 0; d < dim; ++d)
            places[i][d] = static_cast<int>(
              std::floor((points[i][d] - offset[d]) / grid.spacing));
          places[i][dim] = bodies.empty() ? 0 : bodies[i];
        }
      return places;
    }

    /** Numbers by place, of all ranks. */
    template <int dim>
    using PlaceNumbers = std::map<GridPlace<dim>, unsigned int>;

    /** All places that some rank has, each once, numbered in their order.
     *  Collective. */
    template <int dim>
    PlaceNumbers<dim>
    all_places(const std::vector<GridPlace<dim>> &founders,
               const std::vector<GridPlace<dim>> &patches,
               const MPI_Comm                     comm)
    {
      std::set<GridPlace<dim>> mine(founders.begin(), founders.end());
      mine.insert(patches.begin(), patches.end());
      PlaceNumbers<dim> all;
      for (const auto &place :
           of_all_ranks(std::vector<GridPlace<dim>>(mine.begin(), mine.end()),
                        comm))
        all[place] = 0;
      unsigned int n = 0;
      for (auto &entry : all)
        entry.second = n++;
      return all;
    }
  } // namespace


  template <int dim>
  PiecesAtStart
  pieces_at_start(const GridParameters      &grid,
                  const Founders<dim>       &founders,
                  const SurfacePatches<dim> &surface,
                  const MPI_Comm             comm)
  {
    // Every rank gets all occupied grid cells, far fewer than founders, and
    // joins those that touch by Boost's disjoint sets, in the same order. A
    // piece gets its number when the first of its grid cells comes along.
    const auto of_founders =
      places_of<dim>(grid, founders.positions, founders.bodies);
    const auto of_patches =
      places_of<dim>(grid, surface.positions, surface.bodies);
    const PlaceNumbers<dim> numbers =
      all_places<dim>(of_founders, of_patches, comm);

    boost::disjoint_sets_with_storage<> sets(numbers.size());
    for (const auto &[place, number] : numbers)
      for (int k = 0; k < Utilities::pow(3, dim); ++k)
        {
          GridPlace<dim> other = place;
          for (int d = 0, rest = k; d < dim; ++d, rest /= 3)
            other[d] += rest % 3 - 1;
          if (const auto found = numbers.find(other); found != numbers.end())
            sets.union_set(number, found->second);
        }

    PiecesAtStart                        pieces;
    std::map<unsigned int, unsigned int> of_set;
    std::vector<unsigned int>            of_number;
    for (unsigned int number = 0; number < numbers.size(); ++number)
      of_number.push_back(
        of_set.emplace(sets.find_set(number), of_set.size()).first->second);
    pieces.n = of_set.size();
    for (const GridPlace<dim> &place : of_founders)
      pieces.of_founders.push_back(of_number[numbers.at(place)]);
    for (const GridPlace<dim> &place : of_patches)
      pieces.of_patches.push_back(of_number[numbers.at(place)]);
    return pieces;
  }


  MORULA_INSTANTIATE(pieces_at_start);


  template <int dim>
  void
  review_bodies(const GridParameters      &grid,
                const TissueParameters    &tissue,
                const Founders<dim>       &founders,
                const SurfacePatches<dim> &surface,
                const MPI_Comm             comm,
                Review                    &review)
  {
    // A shape is one body. The run says when bodies come to stick later. A gap
    // of two of the longest cells counts, one of a single cell does not.
    if (!tissue.is_from_file())
      return;
    Founders<dim> apart(founders);
    apart.volumes.assign(founders.volumes.size(),
                         std::pow(longest_length(founders, comm), dim));
    apart.bodies                = bodies_apart(apart, comm, 2.5);
    const unsigned int n_bodies = number_of_bodies(apart, comm),
                       n_pieces =
                         pieces_at_start(grid, founders, surface, comm).n;
    if (n_bodies > n_pieces)
      review.warn(grid.spacing.path(),
                  as_text(grid.spacing) + " um",
                  "the tissue is " + std::to_string(n_bodies) +
                    " bodies, of which the grid makes " +
                    std::to_string(n_pieces) +
                    ": those closer than a grid spacing stick together from "
                    "the start.",
                  "Set Contact/Between = bodies, or Grid/Spacing to less than "
                  "half the gap between them.");
  }


  MORULA_INSTANTIATE(review_bodies);


  namespace
  {
    /** Numbers that differ by less are equal. */
    constexpr double rounding = 1e-9;

    /** Mean length of a cell, µm. */
    template <int dim>
    double
    cell_length(const Founders<dim> &founders, const MPI_Comm comm)
    {
      return std::pow(sum_of_all_ranks(founders.volumes, comm) /
                        founders.n_global,
                      1. / dim);
    }

    /** Smallest extent of the tissue along an axis, µm. */
    template <int dim>
    double
    smallest_extent(const TissueParameters    &tissue,
                    const Founders<dim>       &founders,
                    const SurfacePatches<dim> &surface,
                    const MPI_Comm             comm)
    {
      double smallest = std::numeric_limits<double>::infinity();
      // The keys of a shape say how wide it is.
      if (tissue.has_radius())
        smallest = 2. * tissue.radius;
      if (tissue.shape == "sphere" && tissue.inner_radius > 0.)
        smallest = tissue.radius - tissue.inner_radius;
      for (unsigned int d = 0; d < dim; ++d)
        if (tissue.has_size(d))
          smallest = std::min(smallest, tissue.size.value()[d]);
      if (!tissue.is_from_file())
        return smallest;

      // Tissue from a file is as wide as its points reach.
      const bool  has_surface = surface.n_global > 0;
      const auto &points = has_surface ? surface.positions : founders.positions;
      for (unsigned int d = 0; d < dim; ++d)
        {
          double lower = std::numeric_limits<double>::max(), upper = -lower;
          for (const Point<dim> &X : points)
            {
              lower = std::min(lower, X[d]);
              upper = std::max(upper, X[d]);
            }
          smallest = std::min(smallest,
                              Utilities::MPI::max(upper, comm) -
                                Utilities::MPI::min(lower, comm));
        }
      // Positions of cells end half a cell before the tissue does, on both
      // sides.
      return smallest + (has_surface ? 0. : cell_length(founders, comm));
    }
  } // namespace


  template <int dim>
  void
  review_grid(const GridParameters      &grid,
              const TissueParameters    &tissue,
              const Founders<dim>       &founders,
              const SurfacePatches<dim> &surface,
              const bool                 slips,
              const MPI_Comm             comm,
              Review                    &review)
  {
    // Each warning is a finding of doc/hard-cases.md or
    // doc/accuracy-and-cost.md, with the numbers of this scene: too few cells
    // for each grid spacing; tissue thinner than a grid cell; boundary points
    // of slip walls too far apart; no extension.
    const double      h     = grid.spacing;
    const double      L     = cell_length(founders, comm);
    const std::string path  = grid.spacing.path();
    const std::string value = as_text(h) + " um";
    if (h * grid.points_per_cell < (2.5 - rounding) * L)
      review.warn(path,
                  value,
                  "that is " + as_text(h / L) + " cells of " + as_text(L) +
                    " um; below 2.5 energies are wrong by 4 to 10 %, and "
                    "compressed tissue crumples (doc/hard-cases.md, "
                    "classification).",
                  "Choose 3 or more cells per grid spacing: raise "
                  "Grid/Spacing, or lower Tissue/Cell spacing.");

    const double thickness = smallest_extent(tissue, founders, surface, comm);
    if (thickness < (1. - rounding) * h)
      review.warn(
        path,
        value,
        "the tissue is only " + as_text(thickness) +
          " um wide, less than a grid cell: details across its thickness are "
          "lost (doc/hard-cases.md, small_and_thin).",
        "Lower Grid/Spacing to half the thickness if they matter, with " +
          tissue.cell_spacing.path() + " at most a third of that.");

    // Only slip walls are affected: fixed points keep their distances.
    const double patch =
      surface.n_global == 0 ?
        0. :
        std::pow(sum_of_all_ranks(surface.areas, comm) / surface.n_global,
                 1. / (dim - 1));
    if (slips && !tissue.refine_surface && patch > (0.5 - rounding) * h)
      review.warn(tissue.boundary_points.path(),
                  std::to_string(surface.n_global),
                  "they are " + as_text(patch) +
                    " um apart at the start, half of Grid/Spacing = " + value +
                    " or more; where growth takes those of a slip wall farther "
                    "apart than a grid cell, tissue leaks through "
                    "(doc/hard-cases.md, instability).",
                  "Raise their number, or set Tissue/Refine surface = true.");

    if (!grid.extension)
      review.warn(
        grid.extension.path(),
        "false",
        "plain splines fail for a third to a half of the places that the "
        "grid can have (doc/hard-cases.md, cuts).",
        "Set it to true, unless that is what you want to show.");
  }


  MORULA_INSTANTIATE(review_grid);


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
      double enclosed = 0.;
      for (std::size_t i = 0; i < surface.areas.size(); ++i)
        // By the divergence theorem the patches give the volume.
        enclosed +=
          surface.areas[i] / dim * (surface.normals[i] * surface.positions[i]);
      return Utilities::MPI::sum(enclosed, comm) /
             sum_of_all_ranks(founders.volumes, comm);
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
                    "' are not known, and are skipped.",
                  "Columns that count are x, y, z, volume, generation, phase "
                  "and type: correct the name of one that is misspelt.");
    const double length = cell_length(founders, comm);
    if (length < shortest_usual || length > longest_usual)
      review.warn(tissue.cell_spacing.path(),
                  tissue.cell_spacing.text(),
                  "cells are " + as_text(length) +
                    " um long, where 5 to 50 is usual. Is a length in another "
                    "unit than um, such as m, mm or nm?",
                  "Scale places to um and volumes to um^3 (2-D: um^2).");
    const double ratio =
      surface.n_global > 0 ? enclosed_over_cells(founders, surface, comm) : 1.;
    const std::string advice =
      "Give each cell its volume in the file, or set "
      "Tissue/Cell spacing to the length of the cells.";
    if (tissue.is_points() && std::abs(ratio - 1.) > most_off)
      review.warn(tissue.points_file.path(),
                  tissue.points_file,
                  "the surface around the cells encloses " + as_text(ratio) +
                    " times their volume: a pressure on it squeezes them "
                    "by so many times that pressure.",
                  advice);
    if (tissue.is_points() && surface.n_outside > most_off * founders.n_global)
      review.warn(tissue.points_file.path(),
                  tissue.points_file,
                  std::to_string(surface.n_outside) + " of " +
                    std::to_string(founders.n_global) +
                    " cells lie outside the surface around them: they "
                    "leave gaps, and it encloses no more than their volume.",
                  advice);
    if (tissue.is_points() && surface.filled > 0.)
      review.warn(tissue.points_surface.path(),
                  tissue.points_surface,
                  "the surface around the cells has filled cavities: it "
                  "encloses about " +
                    as_text(surface.filled) + (dim == 3 ? " um^3" : " um^2") +
                    " in which no cell is, and lies closer to the cells "
                    "elsewhere for it.",
                  "Fill the holes, or give the surface as a file here.");
    if (tissue.renew_surface > 0.)
      review.warn(tissue.renew_surface.path(),
                  tissue.renew_surface.text(),
                  "it has no effect since 0.3.0: Tissue/Surface says when the "
                  "surface is made anew.",
                  "Remove it.");
    if (!tissue.is_points() && tissue.surface_cells == "whole" &&
        std::abs(1. / ratio - 1.) > most_off_of_lattice)
      review.warn(tissue.cell_spacing.path(),
                  as_text(tissue.cell_spacing) + " um",
                  "the lattice does not fit the shape: its cells have " +
                    as_text(1. / ratio) + " of the shape's volume.",
                  "Choose a spacing that divides the shape, a smaller one, or "
                  "Tissue/Surface cells = trimmed.");
  }


  MORULA_INSTANTIATE(review_units);
} // namespace Morula
