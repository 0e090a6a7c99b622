// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "mechanics/room.h"


TEST_2D_3D(Drag, ResidualAndTangentAreTheEnergysDerivatives)
{
  std::mt19937    generator(3);
  const Drag<dim> term(random_points_in_cell<dim>(generator, 3),
                       {0.1, 0.2, 0.3});
  EXPECT_TRUE(term.is_conservative());
  expect_derivatives(term, random_field<dim>(generator, 0.2));
}


// Σ k |u|²/2, cell by cell.
TEST_2D_3D(Drag, EnergyIsThatOfItsCells)
{
  std::mt19937              generator(5);
  const auto                cells = random_points_in_cell<dim>(generator, 3);
  const std::vector<double> k     = {0.1, 0.2, 0.3};
  const LocalField<dim>     field = random_field<dim>(generator, 0.2);
  double                    exact = 0.;
  for (unsigned int p = 0; p < k.size(); ++p)
    exact += 0.5 * k[p] *
             field.value(SplineValues<dim>(cells.xi[p], cells.h)).norm_square();
  LocalSystem<dim> system(LocalSystem<dim>::energy_and_residual);
  Drag<dim>(cells, k).add(0, field, GrowthAt::current, system);
  EXPECT_GT(exact, 0.);
  EXPECT_NEAR(system.energy, exact, 1e-14 * exact);
}
