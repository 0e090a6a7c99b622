// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/mechanics/drag.h>

#include <gtest/gtest.h>

#include <random>

#include "common/finite_differences.h"

using namespace Morula;

namespace
{
  template <int dim>
  void
  check_drag()
  {
    std::mt19937    generator(3);
    const Drag<dim> term(random_points_in_cell<dim>(generator, 3),
                         {0.1, 0.2, 0.3});
    EXPECT_TRUE(term.is_conservative());
    expect_derivatives(term, random_field<dim>(generator, 0.2));
  }
} // namespace


TEST(Drag, ResidualAndTangentAreTheEnergysDerivatives)
{
  MORULA_BOTH_DIMENSIONS(check_drag)
}
