// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_spline_space_h
#define morula_grid_spline_space_h

#include <morula/grid/background_grid.h>
#include <morula/grid/bspline.h>
#include <morula/grid/extension.h>
#include <morula/grid/occupancy.h>

#include <deal.II/base/index_set.h>

#include <map>
#include <vector>

namespace Morula
{
  /**
   * The extended B-splines around the tissue for one step: which splines are
   * unknowns, their numbers over all ranks, and how the 3^dim splines of each
   * of this rank's active grid cells are expressed by unknowns.
   *
   * An inner spline is an unknown. An outer spline follows from the 3^dim
   * unknowns of an inner grid cell; in a piece that has no inner grid cell,
   * from the dim + 1 unknowns of one affine field. Each unknown is a vector:
   * unknown number s, component i is degree of freedom s dim + i, in µm.
   */
  template <int dim>
  class SplineSpace
  {
  public:
    /** One of this rank's active grid cells. */
    struct Cell
    {
      unsigned int number; // of the grid cell in the box
      /** Unknowns: positions in relevant(), increasing. */
      std::vector<unsigned int> unknowns;
      /** Splines (3^dim rows) by unknowns; empty where the unknowns are the
       *  splines themselves in order. */
      std::vector<double> weights;
    };

    /** Collective, though without communication. */
    SplineSpace(const BackgroundGrid<dim> &grid,
                const Occupancy<dim>      &occupancy,
                const GridParameters      &parameters);

    /** This rank's active grid cells, by number. */
    const std::vector<Cell> &
    cells() const;

    /** Unknown splines this rank owns. */
    const IndexSet &
    owned() const;

    /** Unknown splines that this rank's active grid cells use. */
    const IndexSet &
    relevant() const;

    /** The same for degrees of freedom: dim for each spline. */
    const IndexSet &
    owned_dofs() const;

    const IndexSet &
    relevant_dofs() const;

    /** Counts over all ranks. */
    unsigned int
    n_unknowns() const; // splines times dim
    unsigned int
    n_active_cells() const;
    unsigned int
    n_inner_splines() const;
    unsigned int
    n_outer_splines() const;

    /**
     * The piece that a grid cell belongs to: active grid cells that share a
     * spline are one piece. Only for active grid cells.
     */
    unsigned int
    piece(const unsigned int number) const;

    unsigned int
    n_pieces() const;

    const GridBox<dim> &
    box() const;

    /**
     * Coefficients of the affine field a + A x (µm) in one piece, zero in the
     * others: of this rank's unknowns, in the order of owned_dofs(). Splines
     * reproduce affine fields: the coefficient is the field's value at the
     * spline's centre.
     */
    std::vector<double>
    affine_coefficients(const unsigned int    piece,
                        const Tensor<1, dim> &a,
                        const Tensor<2, dim> &A) const;

    /** The piece of each of this rank's unknowns, in the order of owned(). */
    const std::vector<unsigned int> &
    pieces_of_unknowns() const;

  private:
    enum class Kind : char
    {
      inactive,
      outer,
      inner
    };

    /** A piece without inner grid cells: its affine field's unknowns. */
    struct AffineField
    {
      Point<dim>   center; // µm
      unsigned int first_unknown;
      unsigned int lowest_cell;
    };

    void
    find_kinds();
    void
    find_pieces();
    void
    find_affine_fields();
    void
    number_unknowns(const BackgroundGrid<dim> &grid);
    void
    express_cells(const BackgroundGrid<dim> &grid);
    unsigned int
    piece_of_spline(const unsigned int spline) const;

    /** Global unknowns and weights of one spline. */
    std::vector<std::pair<unsigned int, double>>
    expression(const unsigned int spline, ExtensionSearch<dim> &search) const;

    GridBox<dim>                        box_;
    bool                                extend;
    std::vector<GridCellClass>          classes;
    std::vector<Kind>                   kinds;   // by spline
    std::vector<unsigned int>           numbers; // by spline: unknown's number
    std::vector<unsigned int>           pieces;  // by grid cell
    std::vector<unsigned int>           components; // by grid cell: connected
    std::vector<unsigned int>           pieces_of_unknowns_;
    std::map<unsigned int, AffineField> affine_fields; // by component
    std::vector<Cell>                   cells_;
    IndexSet     owned_, relevant_, owned_dofs_, relevant_dofs_;
    unsigned int n_splines = 0;
    unsigned int n_pieces_ = 0;
    unsigned int n_active  = 0;
    unsigned int n_inner   = 0;
    unsigned int n_outer   = 0;
  };
} // namespace Morula

#endif
