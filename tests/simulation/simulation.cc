// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "simulation/room.h"

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


TEST(Simulation, StartsFromATissueThatIsSeeded)
{
  const Scene           scene = block();
  const SeededTissue<3> tissue =
    seed_tissue(TissueModel<3>(scene), MPI_COMM_WORLD);
  Simulation<3> given(scene, MPI_COMM_WORLD, tissue);
  Simulation<3> seeds(scene, MPI_COMM_WORLD, false);
  const auto   &cells = given.state().cells();
  ASSERT_EQ(cells.size(), seeds.state().cells().size());
  EXPECT_EQ(sum_over_ranks(cells.size()), 500u);
  for (unsigned int p = 0; p < cells.size(); ++p)
    EXPECT_EQ(cells.position(p), seeds.state().cells().position(p));
  const auto &points = given.state().boundary_points();
  EXPECT_EQ(points.size(), seeds.state().boundary_points().size());
  EXPECT_GT(sum_over_ranks(points.size()),
            tissue.surface.n_global); // refined
  const unsigned int n = given.n_unknowns();
  EXPECT_EQ(n, seeds.n_unknowns());
  EXPECT_GT(n, 0u);
}


// Files that are still being written when a snapshot is due: a run that is
// resumed from it would not write them again.
TEST(Simulation, CountsOutputInASnapshotThatIsThere)
{
  const ScratchDirectory directory;
  const std::string      output  = directory / "run";
  Scene                  scene   = block();
  scene.output_directory         = output;
  scene.time.step                = 0.25;
  scene.time.end_time            = 1.;
  scene.output.interval          = 0.25;
  scene.output.snapshot_interval = 0.5;
  Simulation<3> simulation(scene, MPI_COMM_WORLD, false);
  const auto    path = [&](const std::string &name) {
    return output + '/' + name;
  };
  unsigned int n_seen = 0;
  simulation.run([&]() {
    if (!std::filesystem::exists(path("snapshot.h5")))
      return;
    const auto times = read_snapshot<3>(path("snapshot.h5"), MPI_COMM_WORLD)
                         .table("output_times");
    for (unsigned int n = 0; n < times.size(); ++n)
      EXPECT_TRUE(
        std::filesystem::exists(path(numbered_file("cells", n, "vtu"))));
    const std::string list = content(path("cells.pvd"));
    EXPECT_NE(list.find(numbered_file("cells", times.size() - 1, "vtu")),
              std::string::npos);
    n_seen = times.size();
  });
  EXPECT_EQ(n_seen, 5u);
}
