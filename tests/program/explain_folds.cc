// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/explain_folds.h>

#include <deal.II/base/numbers.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace Morula;


// A sphere of radius R that moves with the velocity v feels 6 π η R v.
TEST(ExplainFolds, TheViscosityIsThatOfStokes)
{
  const double length = 10., eta = 3.; // µm, Pa s
  const double radius     = length * std::cbrt(3. / (4. * numbers::PI));
  const double in_kpa_day = eta / 1e3 / 86400.;
  const double force = 6. * numbers::PI * in_kpa_day * radius; // per velocity
  EXPECT_NEAR(viscosity_of_medium(force / std::pow(length, 3), length),
              eta,
              1e-12);
}
