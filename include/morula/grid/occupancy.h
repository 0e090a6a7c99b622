// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_occupancy_h
#define morula_grid_occupancy_h

#include <morula/grid/grid_contents.h>
#include <morula/grid/shared_points.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace Morula
{
  /**
   * How thick the tissue is, from the connected rows of grid cells with tissue
   * along each coordinate. A row's thickness is its volume divided by its
   * cross-section, the smallest rectangle around its tissue; a row of eight
   * grid cells or more is not thin along itself, so that no rank must know all
   * of it.
   *
   * Grid cells at the edge of a window have rows that are cut off. Everything
   * here is what one rank finds in GridWindow::inner(reach) of the window, but
   * for thickness(), which needs eight rings.
   */
  template <int dim>
  class TissueRows
  {
  public:
    static constexpr int reach = 4;

    TissueRows() = default;

    explicit TissueRows(const GridContents<dim> &contents);

    /** Smallest thickness of a grid cell's rows in units of h, at most 1. */
    float
    least_thickness(const unsigned int number) const
    {
      return thicknesses[number];
    }

    /** The largest of these among the grid cell and its neighbours with
     *  tissue, so that the tip of a large body is not thin. */
    float
    thickness(const unsigned int       number,
              const GridContents<dim> &contents) const;

    /** Number of directions in which the grid cell's row is shorter than
     *  1.5 h. */
    unsigned int
    n_thin(const unsigned int number) const
    {
      return n_thin_[number];
    }

    /** See Occupancy. */
    bool
    is_thin(const unsigned int number, const GridContents<dim> &contents) const;

    /** See Occupancy. */
    bool
    is_inner_candidate(const unsigned int number) const
    {
      return candidates[number];
    }

  private:
    void
    measure(const std::vector<unsigned int> &row,
            const unsigned int               direction,
            const GridContents<dim>         &contents);

    std::vector<float> thicknesses; // of rows, in h, at most 1
    std::vector<float> lengths;     // of rows, in h; 2 where no row is thin
    std::vector<char>  n_thin_;     // number of directions with a thin row
    std::vector<char>  candidates;  // see is_inner_candidate()
  };

  /**
   * How full the grid cells are, over all ranks. Each particle's volume is
   * spread over an axis-parallel cube of side V^(1/dim) around it. Counting
   * the points instead would alias: a lattice of five points per grid spacing
   * grown to θ = 1.4 leaves interior grid cells with fill 0.59.
   *
   * It is filled in two rounds. The first adds particles and boundary points
   * and ends with sum(). The second adds the particles' quadrature points,
   * whose number depends on the first round.
   *
   * It is known in the window of this rank: a `number` is that of a grid cell
   * in boxes(), or of a further part of one: see nodes().
   *
   * Volumes are summed as integers. So the result, and with it the
   * classification, does not depend on the order of the points or on the
   * number of ranks.
   */
  template <int dim>
  class Occupancy
  {
  public:
    /**
     * @param points_per_cell least number of quadrature points per edge of a
     *        particle
     * @param share_points whether a quadrature point on a grid line belongs to
     *        all grid cells around it; see SharedPoint
     * @param parting which tissue belongs together, with contact
     */
    explicit Occupancy(const GridWindow<dim>    &window,
                       const unsigned int        points_per_cell = 1,
                       const bool                share_points    = false,
                       const SharedParting<dim> &parting         = {});

    /** The occupancy of a box on one rank. */
    explicit Occupancy(const GridBox<dim> &box);

    /** Adds a particle. @param id of its cell, by which its part is known */
    void
    add_particle(const ParticleDomain<dim>  &domain,
                 const types::particle_index id = 0);

    /** Adds a boundary point at @p x in a part of its grid cell. */
    void
    add_boundary_point(const Point<dim> &x, const unsigned int part = 0);

    /** Ends the first round on one rank. */
    void
    sum();

    /** Sums the first round over all ranks. Collective. */
    void
    sum(const BackgroundGrid<dim> &grid);

    /** Adds the quadrature points (see ParticleDomain) of a particle that was
     *  added before. */
    void
    add_quadrature_points(const ParticleDomain<dim>  &domain,
                          const types::particle_index id = 0);

    /** Whether a particle of this rank has more than one quadrature point, or
     *  one that several grid cells share; after the second round. */
    bool
    subdivides() const
    {
      return subdivides_;
    }

    /** Sums the second round over all ranks. Collective. */
    void
    sum_quadrature_points(const BackgroundGrid<dim> &grid);

    /** Sees a wider window after both rounds, see GridWindow. Collective. */
    void
    widen(const BackgroundGrid<dim> &grid, const bool here);

    /**
     * Quadrature points per edge of a particle. The particle's box and the
     * scene set the number; thin tissue raises it. A sheet that is one cell
     * thick has at least two: with all points in one plane, a displacement
     * that is quadratic across the sheet would cost no energy, so the surface
     * could move although no particle does. A rod needs three points across
     * it, since products of such displacements in both directions across it
     * would cost none: three in each cell of a row of cells, two in each cell
     * of a rod or cluster that is two cells thick.
     */
    typename ParticleDomain<dim>::Numbers
    n_points_per_edge(const ParticleDomain<dim>  &domain,
                      const types::particle_index id = 0) const;

    /** Calls @p visit(position, n) for each of the n grid cells that a
     *  quadrature point at @p x belongs to. The position lies in that grid
     *  cell. */
    template <typename Visitor>
    void
    for_each_share(const Point<dim> &x, const Visitor &visit) const
    {
      if (!share_points)
        {
          visit(x, 1u);
          return;
        }
      const SharedPoint<dim> point(window().whole(), x);
      point.for_each(
        [&](const Point<dim> &position) { visit(position, point.n_shares()); });
    }

    /** Volume of particles in the grid cell divided by h^dim: doc/theory.md
     *  (3.1). */
    double
    fill(const unsigned int number) const
    {
      return contents.volume(number) / GridContents<dim>::resolution;
    }

    /**
     * Thickness (µm) of the tissue around a grid cell, at most h; after sum().
     * A grid cell has the smallest thickness of its rows, see TissueRows. The
     * result is the largest among the grid cell and its neighbours with tissue,
     * so that the tip of a large body is not thin.
     */
    double
    thickness(const unsigned int number) const
    {
      return rows.thickness(number, contents) * boxes().spacing();
    }

    /**
     * Whether the tissue around a grid cell is thin: the grid cell and each
     * of its neighbours with tissue has a row that is shorter than 1.5 h.
     */
    bool
    is_thin(const unsigned int number) const
    {
      return rows.is_thin(number, contents);
    }

    /**
     * Whether the grid cell is the inner candidate of each of its thin rows
     * (shorter than 1.5 h). A thin row has one candidate: its fullest grid
     * cell. Rows in x choose first, rows in y choose among what is left, then
     * rows in z. Of grid cells that are about equally full the first is taken,
     * so that a sheet on both sides of a grid line has all its candidates on
     * one side.
     */
    bool
    is_inner_candidate(const unsigned int number) const
    {
      return rows.is_inner_candidate(number);
    }

    /** Corners (µm) of the smallest box around the particles' cubes in the
     *  grid cell. If there are none, the upper corner is below the lower one.
     */
    std::pair<Point<dim>, Point<dim>>
    bounds(const unsigned int number) const;

    /** Particles in a grid cell. */
    std::uint64_t
    n_particles(const unsigned int number) const
    {
      return contents.n_particles(number);
    }

    /** Quadrature points in a grid cell. */
    unsigned int
    n_quadrature_points(const unsigned int number) const
    {
      return contents.n_quadrature_points(number);
    }

    /** Whether the grid cell of @p x holds more than 4^dim boundary points,
     *  which is more than a surface needs. @p x may lie outside the box. */
    bool
    crowded(const Point<dim> &x) const;

    /** Whether the grid cell holds a particle, a quadrature point or a
     *  boundary point. */
    bool
    active(const unsigned int number) const
    {
      return contents.active(number);
    }

    /** The grid cells of this rank's window. */
    const GridBoxes<dim> &
    boxes() const;

    const GridWindow<dim> &
    window() const;

    const GridNodes<dim> &
    nodes() const
    {
      return contents.nodes();
    }

    /** Nodes with tissue or points that this rank owned when they were summed.
     */
    const std::vector<unsigned int> &
    own() const
    {
      return contents.own();
    }

  private:
    void
    find_crowded();

    unsigned int              points_per_cell;
    bool                      share_points;
    bool                      subdivides_ = false;
    GridContents<dim>         contents;
    TissueRows<dim>           rows;
    std::vector<unsigned int> crowded_; // of all ranks, by number in the grid
  };
} // namespace Morula

#endif
