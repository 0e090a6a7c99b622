// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_block_product_h
#define morula_solver_block_product_h

#include <Epetra_CrsMatrix.h>

#include <vector>

namespace Morula
{
  /**
   * Products with this rank's rows of a matrix of blocks of n × n entries, as a
   * field of n components has them. They read one column a block, not one an
   * entry: a third less memory than Epetra's, and memory is what a product
   * takes. Keeps references to the matrix's entries, which may change.
   */
  class BlockProduct
  {
  public:
    /** @param n 2 or 3; with 1 there are no products */
    BlockProduct(const Epetra_CrsMatrix &K, const unsigned int n);

    /** Whether the matrix has such blocks: if not, there are no products. */
    bool
    exists() const;

    /** y = K x. @param x by local column */
    void
    vmult(double *y, const double *x) const;

  private:
    template <unsigned int n>
    void
    multiply(double *y, const double *x) const;

    /** Reads a row of blocks; false if there are none. */
    bool
    read(const Epetra_CrsMatrix &K, const int first_row);

    unsigned int                n;
    bool                        exists_;
    std::vector<std::size_t>    ends;    // of rows of blocks, in columns
    std::vector<int>            columns; // the first of each block
    std::vector<const double *> rows;    // entries of each row
  };
} // namespace Morula

#endif
