// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/growth/isotropic.h>

#include <gtest/gtest.h>

using namespace Morula;

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


TEST(IsotropicGrowth, HasNoZInThePlane)
{
  EXPECT_DOUBLE_EQ(growth<2>("1 + Y + X").stretch(Point<2>(2., 3.), 1.), 6.);
  EXPECT_THROW(growth<2>("1 + Z + X").stretch(Point<2>(2., 3.), 1.),
               InputError);
}


TEST(IsotropicGrowth, DoesNotGrowByDefault)
{
  const IsotropicGrowth<3> law{IsotropicGrowthParameters()};
  EXPECT_EQ(law.stretch(Point<3>(1., 2., 3.), 7.), 1.);
}


TEST(IsotropicGrowth, RefusesStretchesThatAreNotPositive)
{
  const IsotropicGrowth<3> law = growth("1 - 2*t");
  EXPECT_NO_THROW(law.stretch(Point<3>(), 0.25));
  for (const double t : {0.5, 1.})
    try
      {
        law.stretch(Point<3>(1., 2., 3.), t);
        ADD_FAILURE() << "accepted at t = " << t;
      }
    catch (const InputError &error)
      {
        const std::string message = error.what();
        for (const char *part : {"Growth/Isotropic/Stretch",
                                 "1 - 2*t",
                                 "> 0",
                                 "1 2 3",
                                 "End time"})
          EXPECT_NE(message.find(part), std::string::npos) << message;
      }
}


TEST(IsotropicGrowth, RefusesWhatCannotBeParsed)
{
  EXPECT_THROW(growth("1 +"), InputError);
  EXPECT_THROW(growth(""), InputError);
  EXPECT_THROW(growth("1; 1; 1"), InputError);
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
