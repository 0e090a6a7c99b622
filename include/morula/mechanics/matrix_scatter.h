// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_matrix_scatter_h
#define morula_mechanics_matrix_scatter_h

#include <morula/grid/spline_space.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <mpi.h>

#include <vector>

namespace Morula
{
  /**
   * Makes the sparse matrix of a spline space and adds the condensed matrices
   * of grid cells to it. Rows that this rank owns are written straight into
   * the matrix's own arrays through a table of positions that is made once a
   * step: TrilinosWrappers' add() searches every entry again, which costs more
   * than all the particles at fine grids (doc/theory.md, section 3). Rows of
   * other ranks go through add().
   */
  template <int dim>
  class MatrixScatter
  {
  public:
    using Matrix = TrilinosWrappers::SparseMatrix;

    /** Initialises @p matrix; it must outlive this object. Collective. */
    MatrixScatter(const SplineSpace<dim> &space,
                  Matrix                 &matrix,
                  const MPI_Comm          comm);

    /**
     * Adds a grid cell's matrix; its row and column i m + s is component i of
     * the grid cell's s-th unknown, m their number.
     */
    void
    add(const unsigned int cell, const std::vector<double> &cell_matrix);

  private:
    void
    make_pattern(const MPI_Comm comm);

    void
    make_positions();

    const SplineSpace<dim> &space;
    Matrix                 &matrix;
    std::vector<double *>   rows;         // by owned dof
    std::vector<int>        owned_number; // by relevant unknown
    /** 1 where the columns of an unknown's components follow each other. On
     *  three or more ranks Epetra may order a rank's ghost columns otherwise;
     *  then dim: each component has a position of its own. */
    unsigned int                           width = 1;
    std::vector<std::vector<unsigned int>> positions; // by cell: m x m x width
  };
} // namespace Morula

#endif
