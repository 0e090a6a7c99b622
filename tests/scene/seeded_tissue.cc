// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "scene/room.h"

/** A held block whose cells divide on one side. */
Scene
block()
{
  Scene scene;
  scene.tissue.shape                      = "box";
  scene.tissue.size                       = {100., 100., 50.};
  scene.keys<FixedParameters>().where     = "Z < -24";
  scene.keys<CellCycleParameters>().law   = "cell cycle";
  scene.keys<CellCycleParameters>().where = "X > 0";
  return scene;
}


TEST(SeededTissue, CountsAndWarns)
{
  Scene                 scene = block();
  const SeededTissue<3> tissue =
    seed_tissue(TissueModel<3>(scene), MPI_COMM_WORLD);
  EXPECT_EQ(tissue.founders.n_global, 500u);
  EXPECT_EQ(tissue.n_proliferating, 250u);
  EXPECT_EQ(tissue.counts.points, tissue.surface.n_global);
  EXPECT_GT(tissue.counts.fixed, 0u);
  EXPECT_LT(tissue.counts.fixed, tissue.counts.points);
  EXPECT_TRUE(tissue.warnings.empty());

  scene.grid.spacing = 15.;
  EXPECT_EQ(seed_tissue(TissueModel<3>(scene), MPI_COMM_WORLD).warnings.size(),
            1u);
  scene.keys<CellCycleParameters>().where = "X > 50";
  EXPECT_THROW(seed_tissue(TissueModel<3>(scene), MPI_COMM_WORLD), InputError);
  scene                               = block();
  scene.keys<FixedParameters>().where = "Z < -26";
  EXPECT_THROW(seed_tissue(TissueModel<3>(scene), MPI_COMM_WORLD), InputError);
}
