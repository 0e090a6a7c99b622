// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/scene/checks.h>
#include <morula/scene/seeded_tissue.h>
#include <morula/seeding/bodies.h>

#include <deal.II/base/mpi.h>

#include <boost/algorithm/string/join.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace Morula
{
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
      // Tissue is as wide as its points reach, but for a shell. Positions of
      // cells end half a cell before the tissue does, on both sides.
      const bool  has_surface = surface.n_global > 0;
      const auto &points = has_surface ? surface.positions : founders.positions;
      double      smallest = std::numeric_limits<double>::infinity();
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
      if (tissue.shape == "sphere" && tissue.inner_radius > 0.)
        return tissue.radius - tissue.inner_radius;
      return smallest + (has_surface ? 0. : cell_length(founders, comm));
    }

    template <int dim>
    void
    review_grid(const Scene               &scene,
                const Founders<dim>       &founders,
                const SurfacePatches<dim> &surface,
                const bool                 slips,
                const MPI_Comm             comm,
                Review                    &review)
    {
      const GridParameters   &grid   = scene.grid;
      const TissueParameters &tissue = scene.tissue;
      // Each warning is a finding of doc/hard-cases.md or
      // doc/accuracy-and-cost.md, with the numbers of this scene: too few cells
      // for each grid spacing; tissue thinner than a grid cell; boundary points
      // of slip walls too far apart.
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
        review.warn(
          tissue.boundary_points.path(),
          std::to_string(surface.n_global),
          "they are " + as_text(patch) +
            " um apart at the start, half of Grid/Spacing = " + value +
            " or more; where growth takes those of a slip wall farther "
            "apart than a grid cell, tissue leaks through "
            "(doc/hard-cases.md, instability).",
          "Raise their number, or set Tissue/Refine surface = true.");
    }



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


    template <int dim>
    void
    review_units(const TissueParameters    &tissue,
                 const Founders<dim>       &founders,
                 const SurfacePatches<dim> &surface,
                 const MPI_Comm             comm,
                 Review                    &review)
    {
      // The units of a file are not known, but a length that cells do not have
      // shows; so does a volume within the surface that is not that of the
      // cells. Both are found over all ranks. A column that is not known may be
      // a misspelt one.
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
        review.warn(
          tissue.cell_spacing.path(),
          tissue.cell_spacing.text(),
          "cells are " + as_text(length) +
            " um long, where 5 to 50 is usual. Is a length in another "
            "unit than um, such as m, mm or nm?",
          "Scale places to um and volumes to um^3 (2-D: um^2).");
      const double      ratio = surface.n_global > 0 ?
                                  enclosed_over_cells(founders, surface, comm) :
                                  1.;
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
      if (tissue.is_points() &&
          surface.n_outside > most_off * founders.n_global)
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
        review.warn(
          tissue.renew_surface.path(),
          tissue.renew_surface.text(),
          "it has no effect since 0.3.0: Tissue/Surface says when the "
          "surface is made anew.",
          "Remove it.");
      if (!tissue.is_points() && tissue.surface_cells == "whole" &&
          std::abs(1. / ratio - 1.) > most_off_of_lattice)
        review.warn(
          tissue.cell_spacing.path(),
          as_text(tissue.cell_spacing) + " um",
          "the lattice does not fit the shape: its cells have " +
            as_text(1. / ratio) + " of the shape's volume.",
          "Choose a spacing that divides the shape, a smaller one, or "
          "Tissue/Surface cells = trimmed.");
    }
  } // namespace


  template <int dim>
  std::vector<std::string>
  scene_warnings(const TissueModel<dim>    &model,
                 const Founders<dim>       &founders,
                 const SurfacePatches<dim> &surface,
                 const ConditionCounts     &counts,
                 const MPI_Comm             comm)
  {
    // The order is that of the messages: names of keys, units, grid, then
    // effects in the order in which they act, then the surface, and at last the
    // outputs. Many reviews are collective, so all ranks pass through all of
    // them, with the same list of effects.
    const Scene                   &scene      = model.scene;
    const BoundaryConditions<dim> &conditions = model.boundary_conditions;
    Review                         review;
    for (const std::string &text : scene.renamed)
      review.warnings.push_back("Warning: " + text + '.');
    review_units(scene.tissue, founders, surface, comm, review);
    const bool slips =
      conditions.has(SurfaceCondition::slip) && scene.has_active_tissue();
    review_grid(scene, founders, surface, slips, comm, review);

    Preview<dim> at = preview<dim>(
      model, founders.positions, surface.positions, surface.normals, comm);
    at.volumes = founders.volumes;
    at.types   = types_of<dim>(model, founders.positions, founders.types);
    const double V =
      std::accumulate(founders.volumes.begin(), founders.volumes.end(), 0.);
    at.mean_volume = Utilities::MPI::sum(V, comm) / founders.n_global;
    for (const Effect<dim> *const effect : model.all_effects)
      effect->review(at, review);
    for (const EffectKeys *const keys : scene.keys_in_use())
      keys->check(scene, review);
    for (const auto &[name, equation] : model.equations)
      equation->review(at, review);
    review_idle_keys(scene, review);
    scene.material.review(review);
    for (const auto &[name, condition] : conditions.list())
      condition->review(at, review);
    if (conditions.has_dirichlet())
      scene.nitsche.review(counts.points > 0 && counts.fixed == counts.points,
                           review);
    return review.warnings;
  }


  MORULA_INSTANTIATE(scene_warnings);
} // namespace Morula
