// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "base/room.h"
#include "common/coupled_rows.h"

using CoupledRows::couple, CoupledRows::n, CoupledRows::own_rows;

/** An entry of a matrix that is symmetric with @p skew = 0. */
double
entry(const unsigned int i, const unsigned int j, const double skew)
{
  return std::sin(1. + i * j) + std::cos(1. * i + j) + skew * i;
}

/** The largest difference of y = K x from the sum over all entries. */
double
error(const BlockMatrix &K, const double skew)
{
  const auto          value = [](const auto j) { return std::cos(0.7 * j); };
  BlockMatrix::Vector x(own_rows(), MPI_COMM_WORLD), y(x);
  for (const auto j : own_rows())
    x(j) = value(j);
  K.vmult(y, x);
  double result = 0.;
  for (const auto i : own_rows())
    {
      double expected = 0.;
      for (unsigned int j = 0; j < n; ++j)
        if (couple(i, j))
          expected += entry(i, j, skew) * value(j);
      result = std::max(result, std::abs(y(i) - expected));
    }
  return Utilities::MPI::max(result, MPI_COMM_WORLD);
}

/** With blocks of each size. */
template <typename Action>
void
for_each_size(const Action &action)
{
  for (const unsigned int size : {1, 2, 3})
    {
      SCOPED_TRACE(size);
      action(size);
    }
}

void
fill(BlockMatrix       &K,
     const double       skew,
     const unsigned int size,
     const bool         symmetric)
{
  CoupledRows::fill(
    K,
    [&](const auto i, const auto j) { return entry(i, j, skew); },
    size,
    symmetric);
}


TEST(BlockMatrix, ProductsAreSumsOverAllEntries)
{
  for_each_size([](const unsigned int size) {
    BlockMatrix K;
    fill(K, 0., size, true);
    EXPECT_LE(error(K, 0.), 1e-13);
    const BlockMatrix copy = K;
    fill(K, 0.5, size, false);
    EXPECT_LE(error(K, 0.5), 1e-12);
    EXPECT_LE(error(copy, 0.), 1e-13);
    K.clear();
    EXPECT_EQ(frobenius_norm(K), 0.);
  });
}


TEST(BlockMatrix, DiagonalIsReadAndRaised)
{
  for_each_size([](const unsigned int size) {
    BlockMatrix K;
    fill(K, 0.5, size, false);
    const BlockMatrix::Vector like(own_rows(), MPI_COMM_WORLD);
    auto                      diagonal = K.diagonal(like);
    for (const auto i : own_rows())
      EXPECT_EQ(diagonal(i), entry(i, i, 0.5));
    K.add_to_diagonal(2., diagonal);
    diagonal *= 3.;
    diagonal -= K.diagonal(like);
    EXPECT_LE(diagonal.linfty_norm(), 1e-12);
  });
}


TEST(BlockMatrix, SymmetricPartIsTheMeanWithTheTranspose)
{
  for_each_size([](const unsigned int size) {
    BlockMatrix K, mean;
    fill(K, 0.5, size, false);
    CoupledRows::fill(
      mean,
      [](const auto i, const auto j) {
        return 0.5 * (entry(i, j, 0.5) + entry(j, i, 0.5));
      },
      size);
    const BlockMatrix part = K.symmetric_part();
    EXPECT_TRUE(part.is_symmetric());
    const unsigned int n_rows = part.own().n_elements();
    for (unsigned int row = 0; row < n_rows; ++row)
      for (unsigned int k = 0; k < part.columns(row).size() * size * size; ++k)
        EXPECT_NEAR(part.blocks(row)[k], mean.blocks(row)[k], 1e-14);
  });
}


TEST(BlockMatrix, CountsBothBlocksOfAPair)
{
  BlockMatrix K, all;
  fill(K, 0., 3, true);
  fill(all, 0., 3, false);
  EXPECT_DOUBLE_EQ(K.mean_blocks(), all.mean_blocks());
  unsigned int n_blocks = 0;
  for (unsigned int row = 0; row < all.own().n_elements(); ++row)
    n_blocks += all.columns(row).size();
  EXPECT_DOUBLE_EQ(all.mean_blocks() * all.own().n_elements(), n_blocks);
}
