// ranks: 1 2
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/surface/fixed.h>
#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

using namespace Morula;

namespace
{
  /** A held block, of whose surface the patches are longer than half a grid
   *  cell: they are refined. */
  Scene
  block()
  {
    Scene scene;
    scene.tissue.shape                  = "box";
    scene.tissue.size                   = {100., 100., 50.};
    scene.tissue.boundary_points        = 30;
    scene.tissue.refine_surface         = true;
    scene.keys<FixedParameters>().where = "Z < -24";
    return scene;
  }
} // namespace


TEST(Simulation, StartsFromATissueThatIsSeeded)
{
  const Scene           scene  = block();
  const SeededTissue<3> tissue = seed_tissue<3>(scene, MPI_COMM_WORLD);
  Simulation<3>         given(scene, MPI_COMM_WORLD, tissue);
  Simulation<3>         seeds(scene, MPI_COMM_WORLD, false);
  const auto           &cells = given.state().cells();
  ASSERT_EQ(cells.size(), seeds.state().cells().size());
  EXPECT_EQ(Utilities::MPI::sum(cells.size(), MPI_COMM_WORLD), 500u);
  for (unsigned int p = 0; p < cells.size(); ++p)
    EXPECT_EQ(cells.position(p), seeds.state().cells().position(p));
  const auto &points = given.state().boundary_points();
  EXPECT_EQ(points.size(), seeds.state().boundary_points().size());
  EXPECT_GT(Utilities::MPI::sum(points.size(), MPI_COMM_WORLD),
            tissue.surface.n_global); // refined
  const unsigned int n = given.n_unknowns();
  EXPECT_EQ(n, seeds.n_unknowns());
  EXPECT_GT(n, 0u);
}
