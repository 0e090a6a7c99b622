// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

TEST_2D_3D(Contraction, ShortensAlongItsDirection)
{
  std::mt19937 generator(1);
  for (unsigned int trial = 0; trial < 20; ++trial)
    {
      Tensor<1, dim> a = random_tensor<1, dim>(generator);
      a /= a.norm();
      Tensor<1, dim> b = random_tensor<1, dim>(generator);
      b -= (a * b) * a;
      const double gamma = 0.5 + 0.05 * trial;
      const auto   kept  = active_strain(a, gamma, true);
      EXPECT_LE((kept * a - gamma * a).norm(), 1e-15);
      EXPECT_NEAR(determinant(kept), 1., 1e-14);
      EXPECT_LE((kept * b - std::pow(gamma, dim == 2 ? -1. : -0.5) * b).norm(),
                1e-15);
      const auto free = active_strain(a, gamma, false);
      EXPECT_LE((free * a - gamma * a).norm(), 1e-15);
      EXPECT_LE((free * b - b).norm(), 1e-15);
      EXPECT_LE((active_strain(a, 1., true) - unit_tensor<dim>()).norm(),
                1e-15);
    }
}


TEST(Contraction, IsThereIfSomeCellContracts)
{
  const auto is_on = [](const std::string &stretch) {
    ContractionParameters parameters;
    parameters.stretch = stretch;
    return parameters.is_on();
  };
  EXPECT_FALSE(ContractionParameters().is_on());
  EXPECT_FALSE(is_on("1.0"));
  EXPECT_TRUE(is_on("0.9"));
  EXPECT_TRUE(is_on("1 - 0.1*t"));
  ContractionParameters of_a_type;
  of_a_type.stretch.set_types({{"rest", 0.}, {"muscle", 1.}});
  of_a_type.stretch.set_for_type(1, "Cell types/muscle/Stretch", "0.8");
  EXPECT_TRUE(of_a_type.is_on());
}
