// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_contents_h
#define morula_grid_grid_contents_h

#include <morula/grid/grid_window.h>
#include <morula/grid/particle_domain.h>
#include <morula/grid/parting.h>

#include <array>
#include <cstdint>
#include <vector>

namespace Morula
{
  /**
   * The parts of all grid cells of a window (see Parting), as nodes that tables
   * are numbered by. Without contact a node is a grid cell: it has the number
   * of this one in the GridWindow. That is also the number of the first
   * part of each; further parts come behind all of these.
   */
  template <int dim>
  class GridNodes
  {
  public:
    GridNodes() = default;

    /** @param parting none if there is no contact */
    GridNodes(const GridWindow<dim> &window, const SharedParting<dim> &parting);

    unsigned int
    size() const
    {
      return window.size() + further.size();
    }

    /** Whether each grid cell has one part and is linked with all around. */
    bool
    is_trivial() const
    {
      return near_contest.empty();
    }

    const SharedParting<dim> &
    parting() const
    {
      return parting_;
    }

    /** Coordinates of a node's grid cell. */
    GridIndex<dim>
    index(const unsigned int node) const
    {
      return window.index(grid_cell(node));
    }

    /** The number in the window of a node's grid cell. */
    unsigned int
    grid_cell(const unsigned int node) const
    {
      return node < window.size() ? node : further[node - window.size()].first;
    }

    /** The part of its grid cell that a node is. */
    unsigned int
    part(const unsigned int node) const
    {
      return node < window.size() ? 0 : further[node - window.size()].second;
    }

    /** The number of a node's grid cell in the grid's box, and its part. */
    GridCellPart
    name(const unsigned int node) const
    {
      return {window.whole().number(index(node)), part(node)};
    }

    /** A part of a grid cell of the window. */
    unsigned int
    node(const GridIndex<dim> &index, const unsigned int part) const
    {
      const unsigned int number = window.number(index);
      return part == 0 ? number : first_further[number] + part - 1;
    }

    /** The part that a cell belongs to in a grid cell of the grid's box. */
    unsigned int
    part_of_cell(const types::particle_index id,
                 const unsigned int          number) const
    {
      return is_trivial() ? 0 : parting_->part_of_cell(id, number);
    }

    /** The node that a cell belongs to in a grid cell of the window. */
    unsigned int
    node_of_cell(const GridIndex<dim>       &index,
                 const types::particle_index id) const
    {
      return node(index,
                  is_trivial() || !near_contest[window.number(index)] ?
                    0 :
                    part_of_cell(id, window.whole().number(index)));
    }

    /** Calls visit(node) for all parts of a grid cell of the window. */
    template <typename Visitor>
    void
    for_parts(const unsigned int number, const Visitor &visit) const
    {
      visit(number);
      if (!is_trivial() && first_further[number] > 0)
        for (unsigned int node = first_further[number];
             node < size() && grid_cell(node) == number;
             ++node)
          visit(node);
    }

    /** Whether the nodes of two grid cells that touch, or of one, are linked.
     */
    bool
    are_linked(const unsigned int a, const unsigned int b) const
    {
      return is_trivial() || (!near_contest[grid_cell(a)]) ||
             parting_->are_linked(name(a), name(b));
    }

    /** Whether a grid cell of the window, or one that touches it, is contested.
     */
    bool
    is_near_contest(const unsigned int number) const
    {
      return !is_trivial() && near_contest[number];
    }

    /** Calls visit(node, index) for a node and all that are linked with it in
     *  grid cells that touch its own. */
    template <typename Visitor>
    void
    for_linked(const unsigned int node, const Visitor &visit) const
    {
      if (!is_near_contest(grid_cell(node)))
        window.for_neighbors(index(node), 1, visit);
      else
        for (unsigned int i = first_linked[node]; i < first_linked[node + 1];
             ++i)
          visit(linked[i], index(linked[i]));
    }

  private:
    GridWindow<dim>           window;
    SharedParting<dim>        parting_;
    std::vector<GridCellPart> further;       // numbers in the window
    std::vector<unsigned int> first_further; // node by grid cell, 0 for none
    std::vector<char>         near_contest;  // by grid cell, if any
    /** For each node near a contest those which for_linked() visits. */
    std::vector<unsigned int> first_linked, linked;
  };

  /**
   * What the grid cells of this rank's window hold, over all ranks, by node:
   * without contact that is the number in the GridWindow. Numbers are
   * integers, and a reach is the largest of all: so nothing depends on the
   * order of the points or on the number of ranks.
   */
  template <int dim>
  class GridContents
  {
  public:
    /** Units of volume per grid cell, 2^40. A grid cell can be overfull a
     *  million times before the integers overflow. */
    static constexpr double resolution = 1099511627776.;

    explicit GridContents(const GridWindow<dim>    &window,
                          const SharedParting<dim> &parting = {});

    /** Adds a particle, whose volume is spread over its cube.
     *  @param id of its cell, by which its part is known */
    void
    add_particle(const ParticleDomain<dim>  &domain,
                 const types::particle_index id = 0);

    /** Adds a boundary point at @p x in a part of its grid cell. */
    void
    add_boundary_point(const Point<dim> &x, const unsigned int part = 0)
    {
      ++counts[nodes_.node(window_.whole().locate(x), part)][boundary];
    }

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
    static constexpr unsigned int quadrature = 0, particle = 1, boundary = 2;
    using Counts  = std::array<std::uint32_t, 3>; // of these points
    using Reaches = std::array<float, 2 * dim>;

    struct Record; // of a grid cell

    bool
    holds_something(const unsigned int node) const;

    /** Records of all grid cells with something. */
    std::vector<Record>
    records() const;

    void
    add(const Record &record);

    /** Empties the tables. */
    void
    clear()
    {
      volumes.assign(nodes_.size(), 0);
      counts.assign(nodes_.size(), Counts{});
      reaches.assign(nodes_.size(), Reaches{});
    }

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
