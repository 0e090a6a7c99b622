// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_block_cholesky_h
#define morula_solver_block_cholesky_h

#include <cstddef>
#include <functional>
#include <optional>
#include <type_traits>
#include <vector>

namespace Morula
{
  /** An incomplete Cholesky factorisation M = L Lᵀ of a matrix on one rank. */
  class IncompleteCholesky
  {
  public:
    /** Parameters that determine the factor. */
    struct Parameters
    {
      /** Blocks of the factor over those of the matrix's triangle; the largest
       *  of each column are kept. */
      double fill = 1.;
      /** Blocks of the triangle in a column, in the mean, if these are not the
       *  matrix's own: a part of a matrix has fewer than the whole. */
      std::optional<double> mean_blocks;
      /** So many first rows are to be dropped (solve()); their columns keep
       *  the part @p fill_of_dropped of the others' blocks. */
      int    n_dropped       = 0;
      double fill_of_dropped = 1.;
      /** The diagonal is multiplied by the relative one and raised by the
       *  absolute one. */
      double relative_diagonal = 1.;
      double absolute_diagonal = 0.;
    };

    /** A row of blocks: the numbers of its columns in any order, and the
     *  blocks, each row by row. */
    struct Row
    {
      std::vector<int>    columns;
      std::vector<double> values;
    };

    /** Puts a matrix's row of blocks into the second argument; columns before
     *  the diagonal's are not read. */
    using Rows = std::function<void(const int row, Row &)>;

    virtual ~IncompleteCholesky() = default;

    /** Whether all pivots are positive; else there is no factor. */
    virtual bool
    is_positive() const = 0;

    /** x = L⁻ᵀ D L⁻¹ x, where D is 1 but for the rows to be dropped, in which
     *  it is 0: M⁻¹ x if there are none. */
    virtual void
    solve(double *x) const = 0;
  };

  /**
   * Crout's incomplete factorisation with a limited number of blocks a column,
   * by blocks of n × n entries: those of two splines in n-dimensional space.
   * Single precision, with rows and columns scaled so that the diagonal is 1:
   * a preconditioner needs no more.
   *
   * No library has it: Ifpack's of single entries in double precision took
   * three to four times as long for as many iterations (doc/performance.md, The
   * linear solver), and Ifpack2's are of Tpetra's matrices.
   *
   * N. Li, Y. Saad and E. Chow: Crout versions of ILU for general sparse
   * matrices, SIAM J. Sci. Comput. 25, 716-728 (2003).
   */
  template <int n>
  class BlockCholesky : public IncompleteCholesky
  {
  public:
    /** @param n_rows of the matrix: a multiple of n */
    BlockCholesky(const int         n_rows,
                  const Rows       &rows,
                  const Parameters &parameters);

    bool
    is_positive() const override
    {
      return positive_;
    }

    void
    solve(double *x) const override;

  private:
    // n numbers in one register: three take the place of four.
    typedef float One __attribute__((vector_size(4)));
    typedef float Two __attribute__((vector_size(8)));
    typedef float Four __attribute__((vector_size(16)));
    using Lane =
      std::conditional_t<n == 1, One, std::conditional_t<n == 2, Two, Four>>;

    /** A block of a vector. */
    struct Part
    {
      Lane values;
    };

    /** A block of the factor, by columns. */
    struct Block
    {
      Lane column[n];
    };

    class Column; // of the factor, while it is made

    void
    scale(const Rows &rows, const Parameters &parameters);

    /** Row k of blocks as the matrix's column k. */
    void
    read(const int k, const Rows &rows, Row &row, Column &column) const
    {
      // The matrix is symmetric: row k from the diagonal on is column k below
      // it. So entry j of row i of a block goes to its column i. The factor
      // works on the scaled matrix.
      rows(k, row);
      const double *value = row.values.data();
      for (const int b : row.columns)
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j, ++value)
            if (b >= k)
              column[b].column[i][j] =
                *value * scales[n * k + i] * scales[n * b + j];
      for (int i = 0; i < n; ++i)
        column[k].column[i][i] = 1.; // raised, and scaled
    }

    /** Subtracts what the columns before k contribute to it, and makes them
     *  await their next row. */
    void
    eliminate(const int k, Column &column);

    /** Factors the block on the diagonal; false if it is not positive. */
    bool
    invert_diagonal(const int k, const Block &block);

    /** Keeps the largest blocks of column k. */
    void
    keep(const int k, Column &column);

    int                      n_blocks;
    int                      n_dropped; // of the blocks' rows
    std::vector<float>       scales;    // diag^(-1/2), by row
    std::vector<Block>       diagonal;  // inverses of its lower triangles
    std::vector<std::size_t> begins;    // by column
    std::vector<int>         numbers;   // of block rows, ascending in a column
    std::vector<Block>       blocks;    // below the diagonal
    std::size_t              n_most            = 0; // blocks a column
    std::size_t              n_most_of_dropped = 0;
    bool                     positive_         = true;

    // While it is made, by column: the first block not below the current one,
    // and the next column that awaits the same row; and that list's begin.
    std::vector<std::size_t> firsts;
    std::vector<int>         nexts, heads;
  };
} // namespace Morula

#endif
