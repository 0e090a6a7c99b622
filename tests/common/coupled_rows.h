// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_common_coupled_rows_h
#define morula_tests_common_coupled_rows_h

#include <morula/base/block_matrix.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>

#include <cmath>
#include <vector>

namespace Morula
{
  using namespace dealii;

  /** Puts entry(i, j) into all blocks that a matrix keeps. */
  template <typename Entry>
  void
  set(BlockMatrix &K, const Entry &entry)
  {
    const unsigned int n = K.n_components();
    for (unsigned int row = 0; row < K.own().n_elements(); ++row)
      {
        double *value = K.blocks(row);
        for (const int column : K.columns(row))
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              *value++ =
                entry(n * K.spline_of(row) + i, n * K.spline_of(column) + j);
      }
  }

  inline double
  frobenius_norm(const BlockMatrix &K)
  {
    double             sum  = 0.;
    const unsigned int size = K.n_components() * K.n_components();
    for (unsigned int row = 0; row < K.own().n_elements(); ++row)
      {
        const double *value = K.blocks(row);
        for (const int column : K.columns(row))
          // The transpose of such a block is not kept.
          for (unsigned int k = 0; k < size; ++k, ++value)
            sum += *value * *value *
                   (K.is_symmetric() && column > int(row) &&
                        column < int(K.own().n_elements()) ?
                      2. :
                      1.);
      }
    return std::sqrt(Utilities::MPI::sum(sum, K.communicator()));
  }

  /** |b - K x| */
  inline double
  defect(const BlockMatrix         &K,
         const BlockMatrix::Vector &x,
         const BlockMatrix::Vector &b)
  {
    BlockMatrix::Vector r(b);
    K.vmult(r, x);
    r -= b;
    return r.l2_norm();
  }
} // namespace Morula

/** A matrix whose rows are on several ranks and couple with those of others. */
namespace Morula::CoupledRows
{
  constexpr unsigned int n = 72;

  /** Each six rows couple to the six before and behind, and to some far away.
   */
  inline bool
  couple(const unsigned int i, const unsigned int j)
  {
    const unsigned int a = i / 6, b = j / 6;
    return (a > b ? a - b : b - a) <= 1 || (a + b) % 7 == 0;
  }

  /** Rows of a rank's part: about equal parts, in order; each six on one rank.
   */
  inline IndexSet
  rows_of(const unsigned int rank)
  {
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    IndexSet rows(n);
    rows.add_range(n / 6 * rank / n_ranks * 6,
                   n / 6 * (rank + 1) / n_ranks * 6);
    return rows;
  }

  inline IndexSet
  own_rows()
  {
    return rows_of(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  }

  /** The matrix by blocks of @p n_components rows, with entry(i, j). */
  template <typename Entry>
  void
  fill(BlockMatrix       &K,
       const Entry       &entry,
       const unsigned int n_components = 1,
       const bool         symmetric    = true)
  {
    IndexSet                          own(n / n_components);
    std::vector<BlockMatrix::Columns> columns;
    for (unsigned int row = 0; row < n / n_components; ++row)
      if (own_rows().is_element(row * n_components))
        {
          own.add_index(row);
          columns.emplace_back();
          for (unsigned int column = 0; column < n / n_components; ++column)
            if (couple(row * n_components, column * n_components))
              columns.back().push_back(column);
        }
    own.compress();
    K.reinit(own, columns, n_components, symmetric, MPI_COMM_WORLD);
    set(K, entry);
  }
} // namespace Morula::CoupledRows

#endif
