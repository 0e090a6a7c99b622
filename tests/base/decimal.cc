// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "base/room.h"

TEST(Decimal, ProductsOfAStepAreWhatUsersWrite)
{
  for (const double step : {0.1, 0.05, 0.02, 0.15, 0.3, 1e-3})
    for (unsigned int n = 0; n < 3000; ++n)
      {
        const double written =
          std::stod(std::to_string(n * std::lround(1e3 * step)) + "e-3");
        EXPECT_EQ(decimal(n * step), written) << n << " times " << step;
      }
}


TEST(Decimal, OtherTimesStay)
{
  for (const double t :
       {1. / 3., 0.1 + 1e-14, std::sqrt(2.), 1e7 / 3., -0.7 / 3.})
    EXPECT_EQ(decimal(t), t);
  EXPECT_EQ(decimal(0.), 0.);
}


TEST(Decimal, ExpressionsActWhereTheySay)
{
  const Point<2> X;
  for (unsigned int n = 1; n <= 20; ++n)
    {
      const std::string at = std::to_string(5 * n) + "/100";
      const Expression  at_least("key", "t >= " + at, 1),
        less("key", "t < " + at, 1);
      EXPECT_EQ(at_least.value(X, n * 0.05), 1.) << at;
      EXPECT_EQ(less.value(X, n * 0.05), 0.) << at;
      EXPECT_EQ(at_least.value(X, (n - 1) * 0.05), 0.) << at;
    }
}
