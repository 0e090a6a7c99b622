// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_occupancy_h
#define morula_grid_occupancy_h

#include <morula/grid/grid_box.h>
#include <morula/grid/grid_contents.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace Morula
{
  /** A point on a grid line, which the grid cells on all its sides share in
   *  equal parts: doc/theory.md, section 2.4. */
  template <int dim>
  class SharedPoint
  {
  public:
    /** A point nearer to a grid line than so many grid spacings counts as on
     * it. This is much more than the error of a step's solution, so that a cell
     *  that should stay on a line does so. */
    static constexpr double on_line = 1e-6;

    SharedPoint(const GridBox<dim> &box, const Point<dim> &x)
    {
      const GridIndex<dim> index = box.locate(x);
      const Point<dim>     xi    = box.unit_position(x, index);
      const Point<dim>     lower = box.corner(index);
      for (unsigned int d = 0; d < dim; ++d)
        {
          sides[d] = {{x[d], x[d]}};
          n[d]     = 1;
          for (const double line : {0., 1.})
            if (std::abs(xi[d] - line) < on_line)
              {
                const double at = lower[d] + line * box.spacing();
                sides[d]        = {
                  {at - on_line * box.spacing(), at + on_line * box.spacing()}};
                n[d] = 2;
              }
        }
    }

    /** Number of grid cells that share the point; 1 for a point on no line. */
    unsigned int
    n_shares() const
    {
      unsigned int product = 1;
      for (const unsigned int n_d : n)
        product *= n_d;
      return product;
    }

    /** Calls @p visit(position) for each of these grid cells. A point on a line
     *  is moved a little, so that its position lies in that grid cell. */
    template <typename Visitor>
    void
    for_each(const Visitor &visit) const
    {
      for (unsigned int share = 0; share < n_shares(); ++share)
        {
          Point<dim>   position;
          unsigned int rest = share;
          for (unsigned int d = 0; d < dim; ++d)
            {
              position[d] = sides[d][rest % n[d]];
              rest /= n[d];
            }
          visit(position);
        }
    }

  private:
    std::array<std::array<double, 2>, dim> sides;
    std::array<unsigned int, dim>          n;
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
   * in window(), or of a further part of one: see nodes().
   *
   * Volumes are summed as integers. So the result, and with it the
   * classification, does not depend on the order of the points or on the
   * number of ranks.
   */
  template <int dim>
  class Occupancy : public GridContents<dim>
  {
  public:
    using GridContents<dim>::nodes;
    using GridContents<dim>::window;

    /** Thicknesses and rows are known so many rings inside of the window. */
    static constexpr int reach = 4;

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
                       const SharedParting<dim> &parting         = {})
      : GridContents<dim>(window, parting)
      , points_per_cell(points_per_cell)
      , share_points(share_points)
    {}

    /** The occupancy of a box on one rank. */
    explicit Occupancy(const GridBox<dim> &box)
      : Occupancy(GridWindow<dim>(box))
    {}

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

    /** Sees a wider window after both rounds, see GridWindow. Collective. */
    void
    widen(const BackgroundGrid<dim> &grid, const bool here)
    {
      // The contents travel to the wider window; rows are found anew from
      // these.
      GridContents<dim>::widen(grid, here);
      find_rows();
    }

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
      return this->volume(number) / this->resolution;
    }

    /**
     * Thickness (µm) of the tissue around a grid cell, at most h; after sum().
     * It follows from the connected rows of grid cells with tissue along each
     * coordinate. A row's thickness is its volume divided by its cross-section,
     * the smallest rectangle around its tissue; a row of eight grid cells or
     * more is not thin along itself, so that no rank must know all of it. A
     * grid cell has the smallest thickness of its rows. The result is the
     * largest among the grid cell and its neighbours with tissue, so that the
     * tip of a large body is not thin. Rows are cut off at the edge of a
     * window: this needs eight rings.
     */
    double
    thickness(const unsigned int number) const;

    /**
     * Whether the tissue around a grid cell is thin: the grid cell and each
     * of its neighbours with tissue has a row that is shorter than 1.5 h.
     */
    bool
    is_thin(const unsigned int number) const;

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
      return candidates[number];
    }

    /** Corners (µm) of the smallest box around the particles' cubes in the
     *  grid cell. If there are none, the upper corner is below the lower one.
     */
    std::pair<Point<dim>, Point<dim>>
    bounds(const unsigned int number) const
    {
      // The reaches are units of h from the lower and the upper end of the grid
      // cell.
      Point<dim> lower = window().whole().corner(nodes().index(number)),
                 upper = lower;
      for (unsigned int d = 0; d < dim; ++d)
        {
          upper[d] += this->up(number, d) * window().whole().spacing();
          lower[d] += (1. - this->down(number, d)) * window().whole().spacing();
        }
      return {lower, upper};
    }

    /** Whether the grid cell of @p x holds more than 4^dim boundary points,
     *  which is more than a surface needs. @p x may lie outside the box. */
    bool
    crowded(const Point<dim> &x) const
    {
      const GridBox<dim>  &whole = window().whole();
      const GridIndex<dim> index = whole.locate(x);
      return whole.contains(index) && std::binary_search(crowded_.begin(),
                                                         crowded_.end(),
                                                         whole.number(index));
    }

  private:
    void
    find_crowded()
    {
      // Owners look at their sums, and all ranks get the list: a boundary point
      // may be in a grid cell of any rank when its patch is to be split. It is
      // short, as only crumpled surfaces have such grid cells.
      std::vector<unsigned int> found;
      for (const unsigned int number : this->own())
        if (this->n_boundary_points(number) > Utilities::pow(4u, dim))
          found.push_back(window().whole().number(nodes().index(number)));
      crowded_ = in_one(gather_everywhere(found, window().communicator()));
      std::sort(crowded_.begin(), crowded_.end());
    }

    void
    find_rows();
    void
    measure(const std::vector<unsigned int> &row, const unsigned int direction);

    unsigned int              points_per_cell;
    bool                      share_points;
    bool                      subdivides_ = false;
    std::vector<float>        thicknesses; // of rows, in h, at most 1
    std::vector<float>        lengths;     // of rows, in h; 2: no row is thin
    std::vector<char>         n_thin; // number of directions with a thin row
    std::vector<char>         candidates; // see is_inner_candidate()
    std::vector<unsigned int> crowded_;   // of all ranks, by number in the grid
  };

  /** The role of a grid cell for the splines (doc/theory.md, section 3). The
   *  order counts: see is_active(). */
  enum class GridCellClass : char
  {
    empty,
    /** Holds no points; only particles' cubes reach into it. It connects grid
     *  cells with tissue, and is otherwise treated like an empty one. */
    reached,
    cut,
    inner
  };

  /** Whether a grid cell holds a particle, a quadrature point or a boundary
   *  point. */
  inline bool
  is_active(const GridCellClass grid_cell)
  {
    return grid_cell >= GridCellClass::cut;
  }

  /** How far around a grid cell its class depends on others. */
  template <int dim>
  constexpr int
  reach_of_classes()
  {
    return Occupancy<dim>::reach + 1;
  }

  /**
   * Classifies the grid cells of this rank's window that are reach_of_classes()
   * inside of it; the others count as empty. An active grid cell is *inner* if
   *
   * - its fill is at least C_C min(1, largest fill of it and its neighbours):
   *   doc/theory.md (3.2). The minimum gives thin sheets and small clusters
   *   inner grid cells.
   * - in thin tissue, it is the candidate of its thin rows, see
   *   Occupancy::is_inner_candidate(). Then only such neighbours count in the
   *   rule above. Otherwise a thin body on both sides of a grid line would have
   *   inner grid cells whose outermost splines hardly touch it.
   * - it and its neighbours hold at least 3^dim quadrature points together,
   *   and, unless the tissue is thin, it holds 2^dim of them itself. With fewer
   *   points its splines could not be told apart.
   */
  template <int dim>
  std::vector<GridCellClass>
  classify(const Occupancy<dim> &occupancy, const double occupation_parameter);
} // namespace Morula

#endif
