// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_halo_product_h
#define morula_solver_halo_product_h

#include <morula/base/halo.h>
#include <morula/mechanics/equilibrium.h>

#include <Epetra_BlockMap.h>

#include <optional>
#include <vector>

namespace Morula
{
  /**
   * Products with a distributed matrix by messages between neighbours alone:
   * see Halo. On one rank they are the matrix's own.
   */
  class HaloProduct
  {
  public:
    using Vector = Equilibrium::Vector;
    using Matrix = Equilibrium::Matrix;

    /** Collective. @param K kept as a reference; its entries may change */
    explicit HaloProduct(const Matrix &K);

    const Matrix &
    matrix() const;

    /** Whether this is @p K, with the pattern that it has now. */
    bool
    is_of(const Matrix &K) const;

    /** y = K x. Neighbours have to do the same. */
    void
    vmult(Vector &y, const Vector &x) const;

  private:
    const Matrix       &K;
    Epetra_BlockMap     columns;
    std::optional<Halo> halo; // not on one rank
    std::size_t         n_own;
    std::vector<int>    sources; // of the columns' values, in `gathered`

    mutable std::vector<double> gathered; // own entries, then others
    mutable std::vector<double> values;   // by column
  };
} // namespace Morula

#endif
