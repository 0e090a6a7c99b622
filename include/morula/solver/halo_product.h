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
  class BlockRows;

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

    ~HaloProduct();

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
