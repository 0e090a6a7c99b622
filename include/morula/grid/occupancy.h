// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_occupancy_h
#define morula_grid_occupancy_h

#include <morula/grid/grid_box.h>
#include <morula/grid/particle_domain.h>
#include <morula/grid/shared_points.h>

#include <mpi.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * How full the grid cells are, over all ranks. Each particle's volume is
   * spread over an axis-parallel cube of side V^(1/dim) around it: counting
   * points instead would alias (a lattice of five points per grid
   * spacing grown to θ = 1.4 leaves interior grid cells with fill 0.59).
   *
   * Filled in two rounds: particles and boundary points, sum(), and then the
   * particles' quadrature points, whose number depends on the first round.
   *
   * Volumes are summed as integers, so that the result, and with it the
   * classification, does not depend on the order of the points or on the
   * number of ranks.
   */
  template <int dim>
  class Occupancy
  {
  public:
    /**
     * @param points_per_cell least number of quadrature points of a particle
     *        per edge
     * @param share_points whether a quadrature point on a grid line belongs to
     *        all grid cells around: see SharedPoint
     */
    explicit Occupancy(const GridBox<dim> &box,
                       const unsigned int  points_per_cell = 1,
                       const bool          share_points    = false);

    /** Adds a particle. */
    void
    add_particle(const ParticleDomain<dim> &domain);

    /** Adds a boundary point at @p x. */
    void
    add_boundary_point(const Point<dim> &x);

    /** Sums the first round over all ranks. Collective. */
    void
    sum(const MPI_Comm comm);

    /** Adds the quadrature points (see ParticleDomain) of a particle that was
     *  added before. */
    void
    add_quadrature_points(const ParticleDomain<dim> &domain);

    /** Sums the second round over all ranks. Collective. */
    void
    sum_quadrature_points(const MPI_Comm comm);

    /**
     * Quadrature points per edge of a particle: as many as its box and
     * the scene ask for. Where the tissue is one cell thick, two at least: with
     * all points of a sheet in one plane, a displacement that is quadratic
     * across it could change at no cost of energy. The particles would not
     * notice, but the surface would move. Products of such displacements in
     * both directions across a rod need three points across it: three in each
     * cell of a row, two in a rod or a cluster that is two cells thick.
     */
    typename ParticleDomain<dim>::Numbers
    n_points_per_edge(const ParticleDomain<dim> &domain) const;

    /** Calls @p visit(position, n) for each of the n grid cells that a
     *  quadrature point at @p x belongs to; position is in that grid cell. */
    template <typename Visitor>
    void
    for_each_share(const Point<dim> &x, const Visitor &visit) const
    {
      if (!share_points)
        {
          visit(x, 1u);
          return;
        }
      const SharedPoint<dim> point(box_, x);
      point.for_each(
        [&](const Point<dim> &position) { visit(position, point.n_shares()); });
    }

    /** Volume of particles in the grid cell divided by h^dim: doc/theory.md
     *  (3.1). */
    double
    fill(const unsigned int number) const;

    /**
     * Thickness (µm) of the tissue around a grid cell, after sum(). Along a
     * coordinate, it is the volume in the row of grid cells with tissue that
     * the grid cell belongs to, divided by the row's cross-section, a rectangle
     * that the tissue reaches all sides of. Of the coordinates the smallest
     * counts, and of the grid cell and its neighbours with tissue the largest,
     * so that the tip of a large body is not thin. At most h.
     */
    double
    thickness(const unsigned int number) const;

    /**
     * Whether the tissue around a grid cell is thin: in the grid cell and each
     * of its neighbours with tissue, it ends within 1.5 h along one of the
     * coordinates at least.
     */
    bool
    is_thin(const unsigned int number) const;

    /**
     * Whether the grid cell leads in each of its rows whose tissue ends within
     * 1.5 h: the fullest in x leads, of those that lead in x the fullest in y,
     * and so on. Of grid cells that are about equally full the first leads, so
     * that a sheet on both sides of a grid line is led from one side
     * throughout.
     */
    bool
    leads_thin_rows(const unsigned int number) const;

    /** Corners (µm) of the smallest box around the particles' boxes in the
     *  grid cell; without any, its upper corner below its lower one. */
    std::pair<Point<dim>, Point<dim>>
    bounds(const unsigned int number) const;

    /** Particles in a grid cell. */
    std::uint64_t
    n_particles(const unsigned int number) const;

    /** Quadrature points in a grid cell. */
    unsigned int
    n_quadrature_points(const unsigned int number) const;

    /** Whether more boundary points than a surface needs, 4^dim, share the
     *  grid cell of @p x, which may lie outside the box. */
    bool
    crowded(const Point<dim> &x) const;

    /** Whether the grid cell holds a particle, a quadrature point or a
     *  boundary point. */
    bool
    active(const unsigned int number) const;

    const GridBox<dim> &
    box() const;

  private:
    void
    measure_rows();
    void
    measure_row(const std::vector<unsigned int> &row,
                const unsigned int               direction);
    double
    length(const std::vector<unsigned int> &row,
           const unsigned int               direction) const;
    double
    cross_section(const std::vector<unsigned int> &row,
                  const unsigned int               direction) const;
    float
    largest_around(const std::vector<float> &values,
                   const unsigned int        number) const;

    GridBox<dim>              box_;
    unsigned int              points_per_cell;
    bool                      share_points;
    std::vector<std::int64_t> volumes;
    std::vector<std::int64_t> quadrature_points;
    std::vector<std::int64_t> particles;
    std::vector<std::int64_t> boundary_points;
    /** How far the tissue in a grid cell reaches from its lower and its upper
     *  end, for each direction, by h. */
    std::vector<float> reaches;
    std::vector<float> thicknesses; // of rows, by h; above 1 as 1
    std::vector<float> lengths;     // of rows, by h; those not thin as 2
    std::vector<char>  n_thin;      // directions in which the row is thin
    std::vector<char>  leads;
  };
} // namespace Morula

#endif
