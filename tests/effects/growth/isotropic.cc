// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  template <int dim = 3>
  IsotropicGrowth<dim>
  growth(const std::string &stretch)
  {
    IsotropicGrowthParameters parameters;
    parameters.stretch = stretch;
    return IsotropicGrowth<dim>(parameters);
  }
} // namespace


TEST(IsotropicGrowth, FollowsTheExpressionInSpaceAndTime)
{
  const IsotropicGrowth<3> law = growth("1 + 0.4*t*(X^2 + Y^2 + Z^2)/100");
  EXPECT_DOUBLE_EQ(law.stretch(Point<3>(10., 0., 0.), 0.), 1.);
  EXPECT_DOUBLE_EQ(law.stretch(Point<3>(10., 0., 0.), 1.), 1.4);
  EXPECT_DOUBLE_EQ(law.stretch(Point<3>(0., 6., 8.), 0.5), 1.2);
}


TEST(IsotropicGrowth, IsAGrowthLaw)
{
  const auto         law = growth<2>("1 + t*X");
  GrowingCell<2>     cell{Point<2>(2., 0.), {}, {}};
  const Tensor<2, 2> F_g = law.growth(cell, 0., 0.5);
  EXPECT_DOUBLE_EQ(F_g[0][0], 2.);
  EXPECT_DOUBLE_EQ(F_g[1][1], 2.);
  EXPECT_EQ(F_g[0][1], 0.);
  EXPECT_EQ(F_g[1][0], 0.);
}
