// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_common_coupled_rows_h
#define morula_tests_common_coupled_rows_h

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

/** A matrix whose rows are on several ranks and couple with those of others. */
namespace Morula::CoupledRows
{
  using namespace dealii;

  constexpr unsigned int n = 72;

  /** Each six rows couple to the six before and behind, and to some far away.
   */
  inline bool
  couple(const unsigned int i, const unsigned int j)
  {
    const unsigned int a = i / 6, b = j / 6;
    return (a > b ? a - b : b - a) <= 1 || (a + b) % 7 == 0;
  }

  /** Rows of a rank's part: about equal parts, in order. */
  inline IndexSet
  rows_of(const unsigned int rank)
  {
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    IndexSet rows(n);
    rows.add_range(n * rank / n_ranks, n * (rank + 1) / n_ranks);
    return rows;
  }

  inline IndexSet
  own_rows()
  {
    return rows_of(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  }

  /** Puts entry(i, j) into the own rows. */
  template <typename Entry>
  void
  set(TrilinosWrappers::SparseMatrix &K, const Entry &entry)
  {
    for (const auto i : own_rows())
      for (unsigned int j = 0; j < n; ++j)
        if (couple(i, j))
          K.set(i, j, entry(i, j));
    K.compress(VectorOperation::insert);
  }

  template <typename Entry>
  void
  fill(TrilinosWrappers::SparseMatrix &K, const Entry &entry)
  {
    TrilinosWrappers::SparsityPattern pattern(own_rows(), MPI_COMM_WORLD);
    for (const auto i : own_rows())
      for (unsigned int j = 0; j < n; ++j)
        if (couple(i, j))
          pattern.add(i, j);
    pattern.compress();
    K.reinit(pattern);
    set(K, entry);
  }
} // namespace Morula::CoupledRows

#endif
