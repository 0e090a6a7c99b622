// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "solver/room.h"

/** A symmetric matrix with random entries and rows of very different size,
 *  some far from the diagonal without entries. Positive for a large
 *  @p dominance. */
FullMatrix<double>
random_matrix(const unsigned int size, const double dominance)
{
  std::mt19937                           generator(3);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  FullMatrix<double>                     A(size, size);
  for (unsigned int i = 0; i < size; ++i)
    for (unsigned int j = 0; j <= i; ++j)
      if (const double entry = uniform(generator);
          i == j || i - j < 8 || (i * j) % 5 == 0)
        A(i, j) = A(j, i) =
          (i == j ? dominance : entry) * std::pow(10., 0.1 * (i % 20 + j % 20));
  return A;
}

/** Blocks of n × n entries. */
template <int n>
IncompleteCholesky::Rows
rows_of(const FullMatrix<double> &A)
{
  return [&A](const int row, IncompleteCholesky::Row &result) {
    result.columns.clear();
    result.values.clear();
    for (int b = A.n() / n - 1; b >= 0; --b) // in any order
      {
        result.columns.push_back(b);
        bool is_zero = true;
        for (int i = n * row; i < n * (row + 1); ++i)
          for (int j = n * b; j < n * (b + 1); ++j)
            {
              result.values.push_back(A(i, j));
              is_zero = is_zero && A(i, j) == 0.;
            }
        if (is_zero)
          {
            result.columns.pop_back();
            result.values.resize(n * n * result.columns.size());
          }
      }
  };
}

IncompleteCholesky::Parameters
parameters(const double fill,
           const double relative = 1.,
           const double absolute = 0.)
{
  IncompleteCholesky::Parameters result;
  result.fill              = fill;
  result.relative_diagonal = relative;
  result.absolute_diagonal = absolute;
  return result;
}

/** With room for all blocks the factor is LAPACK's, in single precision. */
template <int n>
void
check_complete()
{
  SCOPED_TRACE(n);
  const unsigned int       size     = 60;
  const FullMatrix<double> A        = random_matrix(size, 8.);
  const double             relative = 1.1, absolute = 0.3;
  const BlockCholesky<n>   factor(size,
                                rows_of<n>(A),
                                parameters(1e3, relative, absolute));
  ASSERT_TRUE(factor.is_positive());

  LAPACKFullMatrix<double> exact(size);
  exact = A;
  for (unsigned int i = 0; i < size; ++i)
    exact(i, i) = relative * A(i, i) + absolute;
  exact.set_property(LAPACKSupport::symmetric);
  exact.compute_cholesky_factorization();
  for (const double unit : {1., 1e-60, 1e60})
    {
      dealii::Vector<double> x(size), expected(size);
      for (unsigned int i = 0; i < size; ++i)
        x(i) = expected(i) = unit * std::sin(1. + i);
      exact.solve(expected);
      factor.solve(x.begin());
      for (unsigned int i = 0; i < size; ++i)
        EXPECT_NEAR(x(i) * std::sqrt(A(i, i)),
                    expected(i) * std::sqrt(A(i, i)),
                    1e-5 * unit)
          << "row " << i;
    }
  dealii::Vector<double> zero(size);
  factor.solve(zero.begin());
  EXPECT_EQ(zero.l2_norm(), 0.);
}

/** An incomplete factor is symmetric and positive, too. */
template <int n>
void
check_incomplete()
{
  SCOPED_TRACE(n);
  const unsigned int       size = 60;
  const FullMatrix<double> A    = random_matrix(size, 12.);
  const BlockCholesky<n>   factor(size, rows_of<n>(A), parameters(0.5));
  ASSERT_TRUE(factor.is_positive());
  const auto inverse_times = [&](const unsigned int i) {
    dealii::Vector<double> x(size);
    x(i) = 1.;
    factor.solve(x.begin());
    return x;
  };
  double defect = 0.;
  for (unsigned int i = 0; i < size; ++i)
    {
      const auto row = inverse_times(i);
      EXPECT_GT(row(i), 0.);
      for (unsigned int j = 0; j < size; ++j)
        {
          const double scale = std::sqrt(A(i, i) * A(j, j));
          EXPECT_NEAR(row(j) * scale, inverse_times(j)(i) * scale, 1e-6);
          double product = i == j ? -1. : 0.;
          for (unsigned int k = 0; k < size; ++k)
            product += row(k) * A(k, j);
          defect =
            std::max(defect, std::abs(product) * std::sqrt(A(i, i) / A(j, j)));
        }
    }
  EXPECT_GT(defect, 1e-3); // blocks were dropped, those that matter least
  EXPECT_LT(defect, 0.11);
}


TEST(BlockCholesky, IsCompleteWithRoomForAllBlocks)
{
  check_complete<1>();
  check_complete<2>();
  check_complete<3>();
}


TEST(BlockCholesky, IsSymmetricWithoutTheSmallBlocks)
{
  check_incomplete<1>();
  check_incomplete<2>();
  check_incomplete<3>();
}


// Columns of dropped rows that keep no block leave the other rows alone.
TEST(BlockCholesky, DroppedRowsKeepTheirPartOfTheBlocks)
{
  const unsigned int       size = 60, n_dropped = 24;
  const FullMatrix<double> A = random_matrix(size, 8.);
  FullMatrix<double>       rest(size - n_dropped, size - n_dropped);
  for (unsigned int i = 0; i < rest.m(); ++i)
    for (unsigned int j = 0; j < rest.n(); ++j)
      rest(i, j) = A(n_dropped + i, n_dropped + j);

  auto keep_none            = parameters(1e3);
  keep_none.n_dropped       = n_dropped;
  keep_none.fill_of_dropped = 0.;
  auto keep_all             = keep_none;
  keep_all.fill_of_dropped  = 1.;
  std::vector<double> without(size, 1.), with(size, 1.), alone(rest.m(), 1.);
  BlockCholesky<3>(size, rows_of<3>(A), keep_none).solve(without.data());
  BlockCholesky<3>(size, rows_of<3>(A), keep_all).solve(with.data());
  BlockCholesky<3>(rest.m(), rows_of<3>(rest), parameters(1e3))
    .solve(alone.data());
  double difference = 0.;
  for (unsigned int i = 0; i < size; ++i)
    {
      const double expected = i < n_dropped ? 0. : alone[i - n_dropped];
      EXPECT_NEAR(without[i], expected, 1e-5 * std::abs(expected));
      difference = std::max(difference, std::abs(with[i] - without[i]));
    }
  EXPECT_GT(difference, 1e-3);
}


// The matrix of M. Kershaw, positive, of which the incomplete factor is not:
// more blocks or a raised diagonal make it so.
TEST(BlockCholesky, SeesThatItIsNotPositive)
{
  FullMatrix<double> A(4, 4);
  const double       entries[4][4] = {{3., -2., 0., 2.},
                                      {-2., 3., -2., 0.},
                                      {0., -2., 3., -2.},
                                      {2., 0., -2., 3.}};
  A.fill(&entries[0][0]);
  EXPECT_FALSE(
    BlockCholesky<1>(4, rows_of<1>(A), parameters(0.9)).is_positive());
  EXPECT_TRUE(BlockCholesky<1>(4, rows_of<1>(A), parameters(2.)).is_positive());
  EXPECT_TRUE(
    BlockCholesky<1>(4, rows_of<1>(A), parameters(0.9, 2.)).is_positive());

  A(2, 2) = -1.;
  EXPECT_FALSE(
    BlockCholesky<2>(4, rows_of<2>(A), parameters(9.)).is_positive());
  A(2, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(
    BlockCholesky<2>(4, rows_of<2>(A), parameters(9.)).is_positive());
}


// A row without entries, and no rows at all.
TEST(BlockCholesky, DoesWithoutEntries)
{
  FullMatrix<double> A(6, 6);
  for (unsigned int i = 0; i < 6; ++i)
    A(i, i) = i == 2 ? 0. : 2.;
  EXPECT_FALSE(
    BlockCholesky<3>(6, rows_of<3>(A), parameters(1.)).is_positive());
  const BlockCholesky<3> factor(6, rows_of<3>(A), parameters(1., 1., 0.5));
  ASSERT_TRUE(factor.is_positive());
  double x[6] = {1., 1., 1., 1., 1., 1.};
  factor.solve(x);
  for (unsigned int i = 0; i < 6; ++i)
    EXPECT_NEAR(x[i], i == 2 ? 2. : 0.4, 1e-6);

  const BlockCholesky<2> empty(0, rows_of<2>(A), parameters(1.));
  EXPECT_TRUE(empty.is_positive());
  empty.solve(nullptr);
}
