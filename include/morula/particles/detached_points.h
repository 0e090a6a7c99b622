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
  /**
   * How much each of these boundary points of this rank belongs to the tissue,
   * that is to cells of its @p sides where it has one. It follows from the
   * distance to the nearest cell and that cell's reach, 1.5 times its present
   * width |F_e| (V⁰ det F_g)^(1/dim) and at least h/4: 1 up to the reach, 0
   * from 4/3 of it on, linear between; doc/theory.md (4.13). Collective.
   */
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

    /** The enclosed volume over that of the cells, of which there are some: q
     *  of doc/theory.md (4.12f). */
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
