// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_halo_product_h
#define morula_solver_halo_product_h

#include <morula/base/halo.h>
#include <morula/mechanics/equilibrium.h>

#include <Epetra_BlockMap.h>
#include <Epetra_CrsMatrix.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace Morula
{
  /**
   * Products with the rows of a matrix that a rank owns, by the blocks of the
   * splines' unknowns. Of a symmetric matrix it reads each pair of blocks once:
   * a product takes as long as the memory takes to deliver the entries, and
   * these take a third of the matrix's own bytes, where columns are numbered
   * entry by entry (doc/performance.md, The linear solver). Epetra's block
   * matrices have pointers for each block and no symmetric form.
   */
  class BlockRows
  {
  public:
    virtual ~BlockRows() = default;

    /**
     * @param K Each row has its diagonal. The unknowns of a spline follow each
     *        other, and its blocks are whole
     * @param order of other ranks' columns: the place of each among them by
     *        ascending numbers; Epetra's own order tears splines apart
     * @param n_components unknowns of a spline, 1 to 3
     * @param symmetric    whether K is
     */
    static std::unique_ptr<BlockRows>
    make(const Epetra_CrsMatrix &K,
         const std::vector<int> &order,
         const unsigned int      n_components,
         const bool              symmetric);

    /** Takes over the entries of a matrix with the pattern of the first. */
    virtual void
    read(const Epetra_CrsMatrix &K) = 0;

    /** y = K x.
     *  @param y by own rows
     *  @param x by columns: the own ones, then those of other ranks by
     *           ascending numbers */
    virtual void
    vmult(double *y, const double *x) const = 0;
  };

  /**
   * Products with a distributed matrix by the blocks of its rows (BlockRows)
   * and messages between neighbours alone (Halo).
   */
  class HaloProduct
  {
  public:
    using Vector = Equilibrium::Vector;
    using Matrix = Equilibrium::Matrix;

    /** Collective.
     *  @param K            kept as a reference
     *  @param n_components unknowns of a spline, 1 to 3
     *  @param symmetric    whether K is */
    HaloProduct(const Matrix      &K,
                const unsigned int n_components,
                const bool         symmetric);

    /** Takes over the entries that K has now. */
    void
    read();

    const Matrix &
    matrix() const
    {
      return K;
    }

    /** Whether this is @p K, with the pattern that it has now. */
    bool
    is_of(const Matrix &K) const;

    /** y = K x. Neighbours have to do the same. */
    void
    vmult(Vector &y, const Vector &x) const;

  private:
    const Matrix              &K;
    Epetra_BlockMap            columns;
    std::unique_ptr<BlockRows> rows;
    std::optional<Halo>        halo; // not on one rank
    std::size_t                n_own;

    mutable std::vector<double> by_column; // on several ranks: x
  };
} // namespace Morula

#endif
