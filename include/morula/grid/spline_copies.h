// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_spline_copies_h
#define morula_grid_spline_copies_h

#include <morula/grid/bspline.h>
#include <morula/grid/occupancy.h>

#include <mpi.h>

#include <array>
#include <cstdint>
#include <vector>

namespace Morula
{
  /** A part of a grid cell (see Parting): the number of the grid cell in the
   *  grid's box, and the part. */
  using NodeName = std::array<unsigned int, 2>;

  /** The copy of a spline that one part of the tissue in its support uses. */
  struct SplineCopy
  {
    unsigned int spline; // number of the grid cell it is centred on
    /** The active grid cells of the part. Bit a stands for the grid cell at the
     *  spline's centre + BSpline::offset(a). Where contact parts grid cells it
     *  is empty; SplineCopies has a list of nodes then. */
    std::uint32_t support;
    bool          inner; // whether an inner grid cell is among them
    /** See SplineCopies. Only known of copies that this rank's grid cells use,
     *  and of those whose splines it owns. */
    unsigned int piece;
    /** Its list of nodes, or none. */
    unsigned int listed = numbers::invalid_unsigned_int;
  };

  /**
   * The splines around the tissue. A spline reaches over 3^dim grid cells. If
   * those with tissue form parts that do not touch each other, each part has
   * its own copy of the spline. (Grid cells touch if they share a vertex; where
   * contact parts them, their nodes have to be linked: see Parting.) So
   * bodies, or arms of one body, with an empty layer of grid cells between them
   * do not feel each other (doc/theory.md, section 3.3).
   *
   * Grid cells that share a copy belong to the same *piece*. A rank knows the
   * copies in its window, of splines that are reach() inside of it. Copies of a
   * spline have the same order on all ranks that know it.
   */
  template <int dim>
  class SplineCopies
  {
  public:
    SplineCopies() = default;

    /** @param classes of the nodes. Collective. */
    SplineCopies(const GridWindow<dim>            &window,
                 const GridNodes<dim>             &nodes,
                 const std::vector<GridCellClass> &classes,
                 const BackgroundGrid<dim>        &grid);

    /** How far around a spline its copies depend on grid cells. */
    static constexpr int
    reach()
    {
      return reach_of_classes<dim>() + 1;
    }

    /** All copies, in the order of their splines' numbers in the window; copies
     *  of one spline in the order of their lowest grid cells. */
    const std::vector<SplineCopy> &
    list() const
    {
      return copies;
    }

    /** The copy of the spline centred on @p spline that the active node
     *  @p node of its support uses: a position in list(). */
    unsigned int
    at(const GridIndex<dim> &spline, const unsigned int node) const;

    /** The active nodes of a copy's support. */
    std::vector<unsigned int>
    nodes_of(const SplineCopy &copy) const;

    /** Copies that stand before this one in list() and have the same spline. */
    unsigned int
    place(const unsigned int copy) const
    {
      return copy - first[copies[copy].spline];
    }

    /** The copy of a spline that has that place. */
    unsigned int
    copy_at(const GridIndex<dim> &spline, const unsigned int place) const
    {
      const unsigned int number = window.number(spline);
      AssertThrow(first[number] + place < first[number + 1],
                  ExcInternalError());
      return first[number] + place;
    }

    /** Coordinates of the grid cell that a copy's spline is centred on. */
    GridIndex<dim>
    center(const unsigned int copy) const
    {
      return window.index(copies[copy].spline);
    }

    /** Whether this rank owns the spline: the grid cell on which it stands. */
    bool
    is_own(const SplineCopy &copy) const
    {
      return own[copy.spline];
    }

    /** The piece of an active node that this rank owns: 0, ...,
     *  n_pieces() - 1 in the order of the pieces' lowest nodes. */
    unsigned int
    piece(const unsigned int node) const
    {
      return pieces[node];
    }

    unsigned int
    n_pieces() const
    {
      return lowest.size();
    }

    /** Lowest grid cell of a piece: its number in the grid's box. */
    unsigned int
    lowest_grid_cell(const unsigned int piece) const
    {
      return lowest[piece][0];
    }

    /** The active nodes that this rank owns, in the order of their names. */
    const std::vector<unsigned int> &
    own_nodes() const
    {
      return own_active;
    }

  private:
    void
    add_copies(const unsigned int                spline,
               const std::vector<GridCellClass> &classes);
    /** As add_copies(), where grid cells are parted. */
    void
    add_copies_of_parts(const unsigned int                spline,
                        const std::vector<GridCellClass> &classes);
    void
    find_own(const std::vector<GridCellClass> &classes,
             const std::vector<char>          &near,
             const BackgroundGrid<dim>        &grid);
    /** Whether this rank's grid cells or splines need the copy. */
    bool
    is_used(const SplineCopy &copy) const
    {
      if (is_own(copy))
        return true;
      for (const unsigned int node : nodes_of(copy))
        if (own[nodes.grid_cell(node)])
          return true;
      return false;
    }

    /** Connects grid cells by the copies that this rank uses. @return number
     *  of parts, which stand in `pieces` */
    unsigned int
    find_parts();
    /** Joins the parts of all ranks. Collective. */
    void
    join_parts(const unsigned int         n_parts,
               const GridBox<dim>        &whole,
               const BackgroundGrid<dim> &grid);

    GridWindow<dim> window;
    GridNodes<dim>  nodes;
    /** Whether this rank owns it, by grid cell of the window; only of those
     *  near active ones. */
    std::vector<char> own;
    /** Whether a node of a spline's support belongs to no part yet; all 0
     *  between splines. */
    std::vector<char>         left;
    std::vector<unsigned int> own_active;
    std::vector<SplineCopy>   copies;
    std::vector<unsigned int> first;  // copy of each spline, and the end
    std::vector<unsigned int> pieces; // by node
    std::vector<NodeName>     lowest; // node by piece
    std::vector<std::vector<unsigned int>> lists; // of nodes, see SplineCopy
  };
} // namespace Morula

#endif
