// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_grid_nodes_h
#define morula_grid_grid_nodes_h

#include <morula/grid/grid_window.h>
#include <morula/grid/parting.h>

#include <vector>

namespace Morula
{
  /**
   * The parts of all grid cells of a window (see Parting), as nodes that tables
   * are numbered by. Without contact a node is a grid cell: it has the number
   * of this one in GridWindow::boxes(). That is also the number of the first
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
      return boxes.size() + further.size();
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
      return boxes.index(grid_cell(node));
    }

    /** The number in the window of a node's grid cell. */
    unsigned int
    grid_cell(const unsigned int node) const
    {
      return node < boxes.size() ? node :
                                   further[node - boxes.size()].grid_cell;
    }

    /** The part of its grid cell that a node is. */
    unsigned int
    part(const unsigned int node) const
    {
      return node < boxes.size() ? 0 : further[node - boxes.size()].part;
    }

    /** The number of a node's grid cell in the grid's box, and its part. */
    GridCellPart
    name(const unsigned int node) const
    {
      return {whole.number(index(node)), part(node)};
    }

    /** A part of a grid cell of the window. */
    unsigned int
    node(const GridIndex<dim> &index, const unsigned int part) const
    {
      const unsigned int number = boxes.number(index);
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
                  is_trivial() || !near_contest[boxes.number(index)] ?
                    0 :
                    part_of_cell(id, whole.number(index)));
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
        boxes.for_neighbors(index(node), 1, visit);
      else
        for (unsigned int i = first_linked[node]; i < first_linked[node + 1];
             ++i)
          visit(linked[i], index(linked[i]));
    }

  private:
    /** Fills `linked`. */
    void
    find_linked();

    struct Further
    {
      unsigned int grid_cell; // in the window
      unsigned int part;
    };

    GridBoxes<dim>            boxes;
    GridBox<dim>              whole;
    SharedParting<dim>        parting_;
    std::vector<Further>      further;
    std::vector<unsigned int> first_further; // node by grid cell, 0 for none
    std::vector<char>         near_contest;  // by grid cell, if any
    /** For each node near a contest those which for_linked() visits. */
    std::vector<unsigned int> first_linked, linked;
  };
} // namespace Morula

#endif
