// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_occupancy_h
#define morula_grid_occupancy_h

#include <morula/grid/grid_box.h>

#include <mpi.h>

#include <cstdint>
#include <vector>

namespace Morula
{
  /**
   * How full the grid cells are, over all ranks. Each particle's volume is
   * spread over the axis-parallel box of side V^(1/dim) that it occupies:
   * counting points instead would alias (a lattice of five points per grid
   * spacing grown to θ = 1.4 leaves interior grid cells with fill 0.59).
   *
   * Volumes are summed as integers, so that the result, and with it the
   * classification, does not depend on the order of the points or on the
   * number of ranks.
   */
  template <int dim>
  class Occupancy
  {
  public:
    /** @param points_per_cell least number of quadrature points of a particle
     *  per direction */
    explicit Occupancy(const GridBox<dim> &box,
                       const unsigned int  points_per_cell = 1);

    /**
     * Adds a particle at @p x with current volume @p V (µm^dim), and its
     * quadrature points (see ParticleDomain).
     */
    void
    add_particle(const Point<dim> &x, const double V);

    void
    add_boundary_point(const Point<dim> &x);

    /** Sums over all ranks. Collective. */
    void
    sum(const MPI_Comm comm);

    /** Volume of particles in the grid cell divided by h^dim. */
    double
    fill(const unsigned int number) const;

    unsigned int
    n_quadrature_points(const unsigned int number) const;

    /** Whether the grid cell holds a particle, a quadrature point or a
     *  boundary point. */
    bool
    active(const unsigned int number) const;

    const GridBox<dim> &
    box() const;

  private:
    GridBox<dim>              box_;
    unsigned int              points_per_cell;
    std::vector<std::int64_t> volumes;
    std::vector<std::int64_t> quadrature_points;
    std::vector<std::int64_t> others; // particles and boundary points
  };

  /** What a grid cell is to the splines (doc/theory.md, section 3). */
  enum class GridCellClass : char
  {
    inactive,
    cut,
    inner
  };

  /**
   * Classifies the grid cells of the box: *inner* is an active grid cell whose
   * fill is at least C_C min(1, largest fill among it and its neighbours) and
   * that holds at least 2^dim quadrature points; the minimum lets thin sheets
   * and small clusters have inner grid cells.
   */
  template <int dim>
  std::vector<GridCellClass>
  classify(const Occupancy<dim> &occupancy, const double occupation_parameter);
} // namespace Morula

#endif
