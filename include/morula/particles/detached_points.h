// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_detached_points_h
#define morula_particles_detached_points_h

#include <morula/particles/tissue.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace Morula
{
  /** The largest distance from a boundary point to its nearest cell, on the
   *  point's side where it has one, µm. Collective. */
  template <int dim>
  double
  largest_distance(const Tissue<dim> &tissue);

  /**
   * How far a cell's part of the tissue reaches, µm: 1.5 times its present
   * width |F_e| (V⁰ det F_g)^(1/dim), at least h/4. No surface of a lattice of
   * cells lies farther from it: doc/theory.md (4.13). Boundary points farther
   * from their nearest cell than that are detached from the tissue.
   */
  template <int dim>
  double
  surface_reach(const CellView<dim, const double> &cell, const double h);

  /**
   * How much a boundary point belongs to the tissue. It follows from the
   * distance to the nearest cell and that cell's reach (µm): 1 up to the reach,
   * 0 from 4/3 of it on, linear between.
   */
  double
  attachment(const double distance, const double reach);

  /** The attachment of each of these boundary points of this rank, to cells of
   *  their @p sides where they have some. Collective. */
  template <int dim>
  std::vector<double>
  attachment(const std::vector<Point<dim>> &points,
             const Tissue<dim>             &tissue,
             const std::vector<Side<dim>>  &sides = {});

  /** Boundary points of this rank that are farther from their nearest cell than
   *  4/3 of its reach, by their positions in the store, in order. Collective,
   *  and there must be cells. */
  template <int dim>
  std::vector<unsigned int>
  detached_points(const Tissue<dim> &tissue);

  /**
   * Pulls detached boundary points back to the tissue. Away from cells the
   * displacement is extrapolated, and a point ahead of the tissue would move
   * away ever faster. Such a point is moved towards its nearest cell until it
   * is within 4/3 of that cell's reach, and takes over the cell's deformation
   * gradient. Fixed points stay where they are held, slip points in their
   * plane.
   * @return how many points were moved, over all ranks. Collective.
   */
  template <int dim>
  std::uint64_t
  pull_back_detached_points(Tissue<dim> &tissue);

  /**
   * Moves boundary points that are farther than @p farthest (µm, at most a grid
   * spacing) from their nearest cell towards it, until they are as near. Their
   * areas and normals stay. Fixed points stay where they are held, slip points
   * in their plane.
   * @return how many points were moved, over all ranks. Collective.
   */
  template <int dim>
  std::uint64_t
  pull_to_cells(Tissue<dim> &tissue, const double farthest);


  /** How the boundary points fit the cells that they enclose. */
  struct SurfaceFit
  {
    /** The largest distance from a boundary point to the cell nearest to it,
     *  µm. */
    double distance = 0.;
    /** The volume that the boundary points enclose, µm^dim. */
    double enclosed = 0.;
    /** The volume of all cells, µm^dim. */
    double cells = 0.;
    /** |Σ a n|/Σ a: how far the surface is from being closed. */
    double opening = 0.;

    /** The enclosed volume over that of the cells, of which there are some. */
    double
    share() const
    {
      return enclosed / cells;
    }
  };

  /** How the surface of the tissue fits its cells; without boundary points only
   *  their volume. @param volume of all cells, µm^dim, if it is known.
   *  Collective. */
  template <int dim>
  SurfaceFit
  surface_fit(const Tissue<dim>           &tissue,
              const std::optional<double> &volume = {});
} // namespace Morula

#endif
