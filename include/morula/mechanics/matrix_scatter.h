// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_matrix_scatter_h
#define morula_mechanics_matrix_scatter_h

#include <morula/mechanics/field_unknowns.h>
#include <morula/mechanics/pair_term.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <Epetra_CrsGraph.h>
#include <mpi.h>

#include <map>
#include <vector>

namespace Morula
{
  /**
   * Makes the sparse matrix of a field of n components on a spline space and
   * adds the condensed matrices of grid cells to it. Without a number of
   * components the field is the displacement. Rows that this rank owns are
   * written straight into the matrix's own arrays through a table of positions
   * that is made once a step: TrilinosWrappers' add() searches every entry
   * again, which costs more than all the particles at fine grids
   * (doc/theory.md, section 3). Rows of other ranks are summed up here in the
   * same way, and sent once.
   */
  template <int dim, int n_components = dim>
  class MatrixScatter
  {
  public:
    using Matrix = TrilinosWrappers::SparseMatrix;

    /** Initialises @p matrix; it must outlive this object. Collective.
     *  @param own_rows as FieldUnknowns::owned()
     *  @param links beside those of the grid cells, see PairTerm */
    MatrixScatter(const SplineSpace<dim>  &space,
                  const IndexSet          &own_rows,
                  Matrix                  &matrix,
                  const MPI_Comm           comm,
                  std::vector<UnknownLink> links = {});

    /**
     * Adds a grid cell's matrix; its row and column i m + s is component i of
     * the grid cell's s-th unknown, m their number. Links have the numbers that
     * follow those of the grid cells, and matrices as in PairTerm.
     */
    void
    add(const unsigned int grid_cell, const std::vector<double> &local_matrix);

    /** Makes all entries zero. */
    void
    clear();

    /** Adds what was added to other ranks' rows to these. Neighbours exchange
     *  it. */
    void
    finish();

  private:
    /** The unknowns that a relevant unknown couples with on this rank, by
     *  relevant unknown. */
    using Couplings = std::vector<std::vector<unsigned int>>;

    Couplings
    couplings() const;

    /** Number of grid cells and links. */
    unsigned int
    n_elements() const
    {
      return space.grid_cells().size() + links.size();
    }

    /** The unknowns of a grid cell, or of a link's rows. */
    const std::vector<unsigned int> &
    rows_of(const unsigned int element) const
    {
      return element < space.grid_cells().size() ?
               space.grid_cells()[element].unknowns :
               links[element - space.grid_cells().size()].rows;
    }

    /** The unknowns of a grid cell, or of a link's columns. */
    const std::vector<unsigned int> &
    columns_of(const unsigned int element) const
    {
      return element < space.grid_cells().size() ?
               space.grid_cells()[element].unknowns :
               links[element - space.grid_cells().size()].columns;
    }

    /** The global unknowns in the rows of an owned unknown, by owned unknown.
     */
    using Unknowns = std::vector<std::vector<types::global_dof_index>>;

    /** Ranks, by relevant unknown. */
    std::vector<unsigned int>
    owners_of_relevant() const;

    /** Messages by rank: an unknown's number, that of its columns, the columns;
     *  then the next unknown's. */
    using Messages =
      std::map<unsigned int, std::vector<types::global_dof_index>>;

    /** Tells the owners of other ranks' rows what will be sent to them.
     *  @return what they tell */
    Messages
    announce(const Couplings &columns, const std::vector<unsigned int> &owners);

    /** Own rows, with the columns that any rank adds to. */
    void
    make_pattern(const Couplings &columns,
                 const Messages  &announced,
                 const IndexSet  &own_rows);

    /** What other ranks have added to own rows, by rank. deal.II's
     *  some_to_some() would ask anew who has something for whom, which takes
     *  barriers of all ranks. */
    std::map<unsigned int, std::vector<double>>
    exchange() const;

    /** Where the entries that other ranks send go. */
    void
    make_received(const Messages &announced);

    /** Where the entries of the grid cells' matrices go. */
    void
    make_positions(const Couplings                 &columns,
                   const std::vector<unsigned int> &owners);

    /**
     * The matrix's structure. Its columns stand in the order of the unknowns,
     * this rank's first, with the components of each side by side: deal.II's
     * SparsityPattern leaves the order to Epetra, which takes three times as
     * long on several ranks to find one, and may part the components.
     * @param unknowns those in the rows of each own unknown
     * @param others those of them that are not owned, sorted
     */
    Epetra_CrsGraph
    graph(const Unknowns                             &unknowns,
          const std::vector<types::global_dof_index> &others,
          const IndexSet                             &own_rows) const;

    /** Position in the matrix's columns of a global unknown's first
     *  component. */
    int
    column_id(const types::global_dof_index unknown) const;

    /** An unknown's rows that another rank adds to. */
    struct Received
    {
      unsigned int              number;    // of the owned unknown
      std::vector<unsigned int> positions; // of the columns' first components
    };

    const SplineSpace<dim>                &space;
    const std::vector<UnknownLink>         links;
    Matrix                                &matrix;
    const MPI_Comm                         comm;
    std::vector<double *>                  rows;         // by relevant dof
    std::vector<int>                       owned_number; // by relevant unknown
    std::vector<std::vector<unsigned int>> positions; // by element, row by row

    /** The values of an owner's rows, one after the other, by owner. */
    std::map<unsigned int, std::vector<double>>   sent;
    std::map<unsigned int, std::vector<Received>> received; // by sender
  };
} // namespace Morula

#endif
