// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_cell_contents_h
#define morula_grid_grid_cell_contents_h

#include <morula/grid/grid_nodes.h>
#include <morula/grid/particle_domain.h>

#include <array>
#include <cstdint>
#include <vector>

namespace Morula
{
  /**
   * What the grid cells of this rank's window hold, over all ranks, by node:
   * without contact that is the number in GridWindow::boxes(). Numbers are
   * integers, and a reach is the largest of all: so nothing depends on the
   * order of the points or on the number of ranks.
   */
  template <int dim>
  class GridCellContents
  {
  public:
    /** Units of volume per grid cell, 2^40. A grid cell can be overfull a
     *  million times before the integers overflow. */
    static constexpr double resolution = 1099511627776.;

    explicit GridCellContents(const GridWindow<dim>    &window,
                              const SharedParting<dim> &parting = {});

    /** Adds a particle, whose volume is spread over its cube.
     *  @param id of its cell, by which its part is known */
    void
    add_particle(const ParticleDomain<dim>  &domain,
                 const types::particle_index id);

    /** Adds a boundary point at @p x. */
    void
    add_boundary_point(const Point<dim> &x, const unsigned int part);

    /** Adds a quadrature point at @p x of the cell with this id. On a grid line
     *  it counts on both sides: else a mirrored tissue would have other classes
     *  of grid cells. */
    void
    add_quadrature_point(const Point<dim> &x, const types::particle_index id);

    /** Sums all but the quadrature points over all ranks. Collective. */
    void
    sum(const BackgroundGrid<dim> &grid);

    /** Ends the sums on one rank. */
    void
    find_own();

    /** Sums the quadrature points over all ranks. Collective. */
    void
    sum_quadrature_points(const BackgroundGrid<dim> &grid);

    /** Sees a wider window, see GridWindow, after all sums. Collective. */
    void
    widen(const BackgroundGrid<dim> &grid, const bool here);

    /** The volume of particles, in units of h^dim / resolution. */
    std::int64_t
    volume(const unsigned int node) const
    {
      return volumes[node];
    }

    /** Number of quadrature points in the grid cell. */
    unsigned int
    n_quadrature_points(const unsigned int node) const
    {
      return counts[node][quadrature];
    }

    /** Number of particles in the grid cell. */
    unsigned int
    n_particles(const unsigned int node) const
    {
      return counts[node][particle];
    }

    /** Number of boundary points in the grid cell. */
    unsigned int
    n_boundary_points(const unsigned int node) const
    {
      return counts[node][boundary];
    }

    /** Whether there is a particle, a quadrature point or a boundary point. */
    bool
    active(const unsigned int node) const
    {
      return n_quadrature_points(node) > 0 || n_particles(node) > 0 ||
             n_boundary_points(node) > 0;
    }

    /** How far the tissue reaches up from the grid cell's lower end, in units
     *  of h. */
    float
    up(const unsigned int node, const unsigned int direction) const
    {
      return reaches[node][2 * direction];
    }

    /** How far the tissue reaches down from the upper end, in units of h. */
    float
    down(const unsigned int node, const unsigned int direction) const
    {
      return reaches[node][2 * direction + 1];
    }

    const GridWindow<dim> &
    window() const
    {
      return window_;
    }

    const GridBoxes<dim> &
    boxes() const
    {
      return window_.boxes();
    }

    const GridNodes<dim> &
    nodes() const
    {
      return nodes_;
    }

    /** Nodes with tissue or points that this rank owned when they were summed.
     */
    const std::vector<unsigned int> &
    own() const
    {
      return own_;
    }

  private:
    enum Kind
    {
      quadrature,
      particle,
      boundary
    };
    using Counts  = std::array<std::uint32_t, 3>; // by Kind
    using Reaches = std::array<float, 2 * dim>;

    /** What ranks tell each other of a grid cell. */
    struct Record
    {
      unsigned int number; // in the grid's box
      unsigned int part;
      Counts       counts;
      Reaches      reaches;
      std::int64_t volume;
    };

    bool
    holds_something(const unsigned int node) const;

    Record
    record(const unsigned int node) const;

    /** Records of all grid cells with something. */
    std::vector<Record>
    records() const;

    void
    add(const Record &record);

    /** Empties the tables. */
    void
    clear();

    /** Replaces what this rank has counted by what all have, from @p records of
     *  its grid cells. Collective. */
    void
    spread(const std::vector<Record> &records);

    GridWindow<dim>           window_;
    GridNodes<dim>            nodes_;
    std::vector<std::int64_t> volumes;
    std::vector<Counts>       counts;
    std::vector<Reaches>      reaches;
    std::vector<unsigned int> own_;
  };
} // namespace Morula

#endif
