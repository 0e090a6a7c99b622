// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "solver/room.h"

using CoupledRows::couple, CoupledRows::n, CoupledRows::own_rows;

/** An entry of a matrix that is symmetric with @p skew = 0. */
double
entry(const unsigned int i, const unsigned int j, const double skew)
{
  return std::sin(1. + i * j) + std::cos(1. * i + j) + skew * i;
}

/** The largest difference of y = @p K x from the sum over all entries. */
double
error(const HaloProduct &K, const double skew)
{
  const auto          value = [](const auto j) { return std::cos(0.7 * j); };
  HaloProduct::Vector x(own_rows(), MPI_COMM_WORLD), y(x);
  for (const auto j : own_rows())
    x(j) = value(j);
  x.compress(VectorOperation::insert);
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

void
set(HaloProduct::Matrix &K, const double skew)
{
  CoupledRows::set(K, [&](const auto i, const auto j) {
    return entry(i, j, skew);
  });
}


TEST(HaloProduct, IsTheMatrixs)
{
  HaloProduct::Matrix K;
  CoupledRows::fill(K,
                    [](const auto i, const auto j) { return entry(i, j, 0.); });
  for (const unsigned int n_components : {1, 2, 3})
    {
      SCOPED_TRACE(n_components);
      set(K, 0.);
      HaloProduct symmetric(K, n_components, true);
      HaloProduct any(K, n_components, false);
      EXPECT_LE(error(symmetric, 0.), 1e-13);
      EXPECT_LE(error(any, 0.), 1e-13);

      set(K, 0.5);
      EXPECT_LE(error(any, 0.), 1e-13);
      any.read();
      EXPECT_LE(error(any, 0.5), 1e-12);

      HaloProduct older(K, n_components, true);
      set(K, 0.);
      EXPECT_GT(error(older, 0.), 0.1);
      older.read();
      EXPECT_LE(error(older, 0.), 1e-13);
    }
}


TEST(HaloProduct, KnowsItsMatrix)
{
  HaloProduct::Matrix K, other;
  CoupledRows::fill(K, [](const auto, const auto) { return 1.; });
  const HaloProduct product(K, 1, true);
  EXPECT_TRUE(product.is_of(K));
  other.copy_from(K);
  EXPECT_FALSE(product.is_of(other));
  CoupledRows::fill(K, [](const auto, const auto) { return 1.; });
  EXPECT_FALSE(product.is_of(K)); // it has another pattern
}
