// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "solver/room.h"

using CoupledRows::couple, CoupledRows::n, CoupledRows::own_rows,
  CoupledRows::rows_of;

double
entry(const unsigned int i, const unsigned int j, const double diagonal)
{
  if (i == j)
    return diagonal + 0.1 * i;
  return -1. / (1. + (i > j ? i - j : j - i));
}

void
fill(BlockMatrix &K, const double diagonal, const unsigned int size = 1)
{
  CoupledRows::fill(
    K, [&](const auto i, const auto j) { return entry(i, j, diagonal); }, size);
}

/** Rows of lower ranks that a rank's rows couple with. */
IndexSet
others_of(const unsigned int rank)
{
  IndexSet   others(n);
  const auto own = rows_of(rank);
  for (const auto i : own)
    for (unsigned int j = 0; j < own.nth_index_in_set(0); ++j)
      if (couple(i, j))
        others.add_index(j);
  others.compress();
  return others;
}

/** Adds @p factor (R K Rᵀ)⁻¹ R x, in some rows R, to y. */
void
add_inverse(const IndexSet            &rows,
            const double               diagonal,
            const double               factor,
            const std::vector<double> &x,
            std::vector<double>       &y)
{
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
  if (m == 0)
    return;
  block.compute_lu_factorization();
  block.solve(part);
  for (unsigned int a = 0; a < m; ++a)
    y[rows.nth_index_in_set(a)] += factor * part[a];
}

/** The second form of doc/theory.md (7.2): of each block's inverse that of
 *  its others is taken off. */
std::vector<double>
exact(const std::vector<double> &x, const double diagonal)
{
  std::vector<double> y(n, 0.);
  for (unsigned int rank = 0; rank < number_of_ranks(); ++rank)
    {
      const IndexSet others = others_of(rank);
      IndexSet       all    = others;
      all.add_indices(rows_of(rank));
      add_inverse(all, diagonal, 1., x, y);
      add_inverse(others, diagonal, -1., x, y);
    }
  return y;
}


/** With room for all entries the factorisations are complete, in single
 *  precision. */
TEST(OverlappingCholesky, HasTheRanksRowsOfTheirBlocksInverseFactors)
{
  const double                diagonal = 6.;
  BlockMatrix                 K;
  std::vector<double>         all(n);
  OverlappingCholesky::Vector x(own_rows(), MPI_COMM_WORLD), y(x);
  for (unsigned int i = 0; i < n; ++i)
    all[i] = std::sin(1. + i);
  for (const auto i : own_rows())
    x(i) = all[i];
  const std::vector<double>       expected = exact(all, diagonal);
  OverlappingCholesky::Parameters parameters;
  parameters.fill = 100.;
  for (const unsigned int n_components : {1, 2, 3})
    {
      fill(K, diagonal, n_components);
      const OverlappingCholesky P(K, parameters);
      EXPECT_TRUE(P.is_positive());
      P.vmult(y, x);
      for (const auto i : own_rows())
        EXPECT_NEAR(y(i), expected[i], 1e-6) << "row " << i;
    }
}


TEST(OverlappingCholesky, RaisesTheDiagonal)
{
  BlockMatrix K, raised;
  fill(K, 6.);
  CoupledRows::fill(raised, [&](const auto i, const auto j) {
    return i == j ? 1.5 * entry(i, i, 6.) + 0.25 : entry(i, j, 6.);
  });
  OverlappingCholesky::Parameters parameters, none;
  parameters.relative_diagonal = 1.5;
  parameters.absolute_diagonal = 0.25;
  const OverlappingCholesky   P(K, parameters);
  const OverlappingCholesky   Q(raised, none);
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
  BlockMatrix K;
  fill(K, -1.); // rows 0 to 9 have no positive diagonal
  const OverlappingCholesky P(K, {});
  EXPECT_TRUE(Utilities::MPI::logical_or(!P.is_positive(), MPI_COMM_WORLD));
}
