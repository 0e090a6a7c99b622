// ranks: 1 2 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/overlapping_cholesky.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>
#include <deal.II/lac/vector.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace Morula;

namespace
{
  constexpr unsigned int n = 30;

  /** Each row couples to its four neighbours by number. */
  double
  entry(const unsigned int i, const unsigned int j, const double diagonal)
  {
    if (i == j)
      return diagonal + 0.1 * i;
    return -1. / (1. + (i > j ? i - j : j - i));
  }

  bool
  couple(const unsigned int i, const unsigned int j)
  {
    return (i > j ? i - j : j - i) <= 2;
  }

  /** Rows of a rank's part: about equal parts, in order. */
  IndexSet
  rows_of(const unsigned int rank)
  {
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    IndexSet rows(n);
    rows.add_range(n * rank / n_ranks, n * (rank + 1) / n_ranks);
    return rows;
  }

  IndexSet
  own_rows()
  {
    return rows_of(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  }

  void
  fill(TrilinosWrappers::SparseMatrix &K, const double diagonal)
  {
    TrilinosWrappers::SparsityPattern pattern(own_rows(), MPI_COMM_WORLD);
    for (const auto i : own_rows())
      for (unsigned int j = 0; j < n; ++j)
        if (couple(i, j))
          pattern.add(i, j);
    pattern.compress();
    K.reinit(pattern);
    for (const auto i : own_rows())
      for (unsigned int j = 0; j < n; ++j)
        if (couple(i, j))
          K.set(i, j, entry(i, j, diagonal));
    K.compress(VectorOperation::insert);
  }

  /** Rows that a rank's block has besides its own: some near ones and, for
   *  @p reach > 0, one far away. */
  IndexSet
  others_of(const unsigned int rank, const unsigned int reach)
  {
    IndexSet   others(n);
    const auto own = rows_of(rank);
    for (unsigned int i = 0; i < n; ++i)
      for (const auto k : own)
        if ((i > k ? i - k : k - i) <= reach)
          others.add_index(i);
    if (reach > 0)
      others.add_index((rank * 7 + n / 2) % n);
    others.compress();
    return others;
  }

  /** Σ Rᵀ (R K Rᵀ)⁻¹ R x over all ranks' blocks. */
  std::vector<double>
  exact(const std::vector<double> &x,
        const double               diagonal,
        const unsigned int         reach)
  {
    std::vector<double> y(n, 0.);
    for (unsigned int rank = 0;
         rank < Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
         ++rank)
      {
        IndexSet rows = others_of(rank, reach);
        rows.add_indices(rows_of(rank));
        const unsigned int       m = rows.n_elements();
        LAPACKFullMatrix<double> block(m);
        dealii::Vector<double>   part(m);
        for (unsigned int a = 0; a < m; ++a)
          {
            const auto i = rows.nth_index_in_set(a);
            part[a]      = x[i];
            for (unsigned int b = 0; b < m; ++b)
              if (const auto j = rows.nth_index_in_set(b); couple(i, j))
                block(a, b) = entry(i, j, diagonal);
          }
        block.compute_lu_factorization();
        block.solve(part);
        for (unsigned int a = 0; a < m; ++a)
          y[rows.nth_index_in_set(a)] += part[a];
      }
    return y;
  }
} // namespace


/** With room for all entries the factorisations are complete, in single
 *  precision. */
TEST(OverlappingCholesky, AddsUpTheBlocksInverses)
{
  const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const double       diagonal = 3.;
  TrilinosWrappers::SparseMatrix K;
  fill(K, diagonal);
  OverlappingCholesky::Parameters parameters;
  parameters.fill = 10.;
  for (const unsigned int reach : {0u, 1u, 4u, n})
    {
      const OverlappingCholesky P(K, others_of(rank, reach), 1, parameters);
      EXPECT_TRUE(P.is_positive());
      std::vector<double>         all(n);
      OverlappingCholesky::Vector x(own_rows(), MPI_COMM_WORLD), y(x);
      for (unsigned int i = 0; i < n; ++i)
        all[i] = std::sin(1. + i);
      for (const auto i : own_rows())
        x(i) = all[i];
      x.compress(VectorOperation::insert);
      P.vmult(y, x);
      const std::vector<double> expected = exact(all, diagonal, reach);
      for (const auto i : own_rows())
        EXPECT_NEAR(y(i), expected[i], 1e-6) << "row " << i;
    }
}


TEST(OverlappingCholesky, RaisesTheDiagonal)
{
  TrilinosWrappers::SparseMatrix K, raised;
  fill(K, 3.);
  fill(raised, 3.);
  for (const auto i : own_rows())
    raised.set(i, i, 1.5 * entry(i, i, 3.) + 0.25);
  raised.compress(VectorOperation::insert);
  OverlappingCholesky::Parameters parameters, none;
  parameters.relative_diagonal = 1.5;
  parameters.absolute_diagonal = 0.25;
  const OverlappingCholesky   P(K, own_rows(), 1, parameters);
  const OverlappingCholesky   Q(raised, own_rows(), 1, none);
  OverlappingCholesky::Vector x(own_rows(), MPI_COMM_WORLD), y(x), z(x);
  x = 1.;
  P.vmult(y, x);
  Q.vmult(z, x);
  z -= y;
  EXPECT_LT(z.linfty_norm(), 1e-6 * y.linfty_norm());
  EXPECT_GT(y.linfty_norm(), 0.);
}


TEST(OverlappingCholesky, KnowsWhenItIsNotPositive)
{
  TrilinosWrappers::SparseMatrix K;
  fill(K, -1.); // rows 0 to 9 have no positive diagonal
  const OverlappingCholesky P(K, IndexSet(n), 1, {});
  EXPECT_TRUE(Utilities::MPI::logical_or(!P.is_positive(), MPI_COMM_WORLD));
}
