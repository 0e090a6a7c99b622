// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_spline_space_h
#define morula_grid_spline_space_h

#include <morula/grid/background_grid.h>
#include <morula/grid/bspline.h>
#include <morula/grid/unknown_numbers.h>

#include <deal.II/base/index_set.h>

#include <map>
#include <vector>

namespace Morula
{
  /**
   * The space of one step: the extended B-splines around the tissue. It says
   * which splines are unknowns, which numbers these have over all ranks, and
   * how the 3^dim splines of each of this rank's active grid cells follow from
   * them.
   *
   * "Spline" here means one copy of a spline (see SplineCopies). An inner
   * spline is an unknown. An outer spline follows from the 3^dim unknowns of an
   * inner grid cell, or from a mean over several (see ExtensionSearch). The
   * splines of a small piece follow from one polynomial (see
   * find_small_pieces()): a tensor product of quadratics has monomials up to
   * degree 2 dim, which nearly vanish on a small piece. An unknown is one
   * number of a scalar field; a field of several components has one for each
   * component (see FieldUnknowns).
   */
  template <int dim>
  class SplineSpace
  {
  public:
    /** One of this rank's active grid cells. */
    struct GridCell
    {
      unsigned int number; // of the grid cell in the grid's box
      /** The unknowns, as positions in relevant(), each of them once. */
      std::vector<unsigned int> unknowns;
      /** Weights of the unknowns (columns) in the splines (3^dim rows). Empty
       *  if unknowns[a] is spline a itself: most grid cells are without, also
       *  between two ranks, where the numbers do not increase with a. */
      std::vector<double> weights;
      /** Whether the tissue around is thin, see Occupancy::is_thin(). */
      bool thin;
      /** The part of the tissue there whose splines these are: the body, where
       *  each has a space of its own, or that of Parting; else 0. A grid cell
       *  of several parts stands in the list once for each. */
      unsigned int part = 0;
    };

    /** @param occupancy after both rounds. Collective. */
    SplineSpace(const BackgroundGrid<dim> &grid,
                Occupancy<dim>             occupancy,
                const GridParameters      &parameters);

    /**
     * The splines of several bodies, each of which has its own space on the
     * same grid: no spline belongs to two of them. Collective.
     * @param bodies spaces by number of the body
     */
    SplineSpace(std::vector<SplineSpace> bodies, const MPI_Comm comm);

    /** Whether a grid cell may have several parts. */
    bool
    is_parted() const
    {
      return !bodies.empty() || !occupancy_.nodes().is_trivial();
    }

    /** The number of bodies with a space of their own; 1 without contact, and
     *  where parts are found cell by cell. */
    unsigned int
    n_bodies() const
    {
      return bodies.empty() ? 1 : bodies.size();
    }

    /** The part that a cell of this body belongs to in a grid cell that it
     *  reaches. */
    unsigned int
    part_of_cell(const types::particle_index id,
                 const unsigned int          body,
                 const unsigned int          number) const
    {
      return bodies.empty() ? occupancy_.nodes().part_of_cell(id, number) :
                              body;
    }

    /** The node in occupancy(grid_cell.part) of one of grid_cells(). */
    unsigned int
    node(const GridCell &grid_cell) const
    {
      return occupancy(grid_cell.part)
        .nodes()
        .node(box().index(grid_cell.number),
              bodies.empty() ? grid_cell.part : 0);
    }

    /** Whether a point of this part of the grid cell with this number belongs
     *  to @p grid_cell. */
    bool
    is_at(const GridCell    &grid_cell,
          const unsigned int number,
          const unsigned int part) const
    {
      return grid_cell.number == number &&
             (!is_parted() || grid_cell.part == part);
    }

    /** The place in grid_cells() of this rank's active grid cell with this
     *  number that has the splines of this part. */
    unsigned int
    entry(const unsigned int number, const unsigned int part) const
    {
      const auto found =
        std::lower_bound(grid_cells_.begin(),
                         grid_cells_.end(),
                         std::make_pair(number, is_parted() ? part : 0u),
                         [](const GridCell &grid_cell, const auto &wanted) {
                           return std::make_pair(grid_cell.number,
                                                 grid_cell.part) < wanted;
                         });
      Assert(found != grid_cells_.end() && is_at(*found, number, part),
             ExcInternalError());
      return found - grid_cells_.begin();
    }

    /** Makes unknowns of other ranks relevant. The places of all unknowns in
     *  relevant() change. */
    void
    add_relevant(const IndexSet &unknowns)
    {
      const IndexSet before = relevant_;
      relevant_.add_indices(unknowns);
      relevant_.compress();
      for (GridCell &grid_cell : grid_cells_)
        for (unsigned int &unknown : grid_cell.unknowns)
          unknown =
            relevant_.index_within_set(before.nth_index_in_set(unknown));
    }

    /** This rank's active grid cells in the order of their numbers, then of
     *  their parts. */
    const std::vector<GridCell> &
    grid_cells() const
    {
      return grid_cells_;
    }

    /** The unknowns that this rank owns. */
    const IndexSet &
    owned() const
    {
      return owned_;
    }

    /** The unknowns that this rank's active grid cells use, and those that it
     *  owns. */
    const IndexSet &
    relevant() const
    {
      return relevant_;
    }

    /** Counts over all ranks. */
    unsigned int
    n_unknowns() const
    {
      return owned_.size();
    }

    unsigned int
    n_active_grid_cells() const
    {
      return n_active;
    }

    unsigned int
    n_inner_splines() const
    {
      return n_inner;
    }

    unsigned int
    n_outer_splines() const
    {
      return n_outer;
    }

    /** The piece of an active grid cell of this rank, by its number in the
     *  grid's box, and of one of the parts there; see SplineCopies. */
    unsigned int
    piece(const unsigned int number, const unsigned int part = 0) const
    {
      if (!bodies.empty())
        return first_piece[part] + bodies[part].piece(number);
      return copies.piece(
        occupancy_.nodes().node(box().index(number), is_parted() ? part : 0));
    }

    unsigned int
    n_pieces() const
    {
      return bodies.empty() ? copies.n_pieces() : first_piece.back();
    }

    /** The box of the grid. */
    const GridBox<dim> &
    box() const
    {
      return occupancy().window().whole();
    }

    /** What the grid cells hold of a body; of the tissue where bodies are not
     *  parted. */
    const Occupancy<dim> &
    occupancy(const unsigned int body = 0) const
    {
      return bodies.empty() ? occupancy_ : bodies[body].occupancy_;
    }

    /**
     * This rank's unknowns, in the order of owned(), for the field that is
     * a + g·x in one piece and zero in the others. Splines reproduce affine
     * fields: the coefficient is the field's value at the spline's centre.
     * @param gradient g, per µm
     */
    std::vector<double>
    affine_coefficients(const unsigned int    piece,
                        const double          a,
                        const Tensor<1, dim> &gradient) const;

    /** The piece of each of this rank's unknowns, in the order of owned(). */
    const std::vector<unsigned int> &
    pieces_of_unknowns() const
    {
      return pieces_;
    }

  private:
    using Terms = std::vector<std::pair<unsigned int, double>>;

    /** The inner grid cells that outer copies are expressed by. */
    using Blocks = std::map<unsigned int, std::vector<unsigned int>>;

    /** Classes, copies and small pieces, and where this rank's outer copies
     *  find inner grid cells. @return whether this rank's window is wide enough
     *  for that. Collective. */
    bool
    find_splines(const BackgroundGrid<dim> &grid,
                 const GridParameters      &parameters);
    void
    count(const MPI_Comm comm)
    {
      // Each rank counts its own grid cells and splines. Splines of small
      // pieces count as outer ones.
      std::vector<unsigned int> n{
        static_cast<unsigned int>(copies.own_nodes().size()), 0, 0};
      for (const SplineCopy &copy : copies.list())
        if (copies.is_own(copy))
          ++n[copy.inner && small_pieces.count(copy.piece) == 0 ? 1 : 2];
      Utilities::MPI::sum(n, comm, n);
      n_active = n[0];
      n_inner  = n[1];
      n_outer  = n[2];
    }

    bool
    is_unknown(const SplineCopy &copy) const
    {
      return !extend || (copy.inner && small_pieces.count(copy.piece) == 0);
    }

    std::vector<unsigned int>
    copies_of_others() const;
    void
    add_grid_cell(const unsigned int node, const std::vector<Terms> &rows);
    void
    find_relevant();

    /** The copy of spline @p a of a node's grid cell. */
    unsigned int
    copy_at(const unsigned int node, const unsigned int a) const;

    /** The global unknowns of a spline that is none itself, and their weights.
     */
    Terms
    expression(const unsigned int copy) const;

    Occupancy<dim>                               occupancy_;
    bool                                         extend;
    std::vector<GridCellClass>                   classes;
    SplineCopies<dim>                            copies;
    Blocks                                       blocks;
    std::map<unsigned int, PiecePolynomial<dim>> small_pieces;
    UnknownNumbers<dim>                          numbers;
    std::vector<GridCell>                        grid_cells_;
    IndexSet                                     owned_, relevant_;
    std::vector<unsigned int>                    pieces_; // of owned unknowns
    std::vector<SplineSpace>                     bodies;  // if parted
    std::vector<unsigned int> first_piece; // of each body, and the end
    unsigned int              n_active = 0;
    unsigned int              n_inner  = 0;
    unsigned int              n_outer  = 0;
  };
} // namespace Morula

#endif
