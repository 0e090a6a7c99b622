// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
// ranks: 1 3

#include "scene/room.h"

/** Patches on the faces z = -1 and z = 1, one of each on every rank. */
SurfacePatches<3>
two_faces()
{
  SurfacePatches<3> surface;
  for (const double z : {-1., 1.})
    {
      surface.positions.emplace_back(this_rank(), 0., z);
      surface.normals.push_back(Tensor<1, 3>({0., 0., z}));
      surface.areas.push_back(1.);
    }
  return surface;
}


TEST(SceneSize, KnowsTheVolumeOfTheShapes)
{
  Scene scene;
  EXPECT_NEAR(initial_size(scene).cells, 65449.8, 0.1);
  scene.tissue.shape = "box";
  EXPECT_DOUBLE_EQ(initial_size(scene).cells, 8000.);
  scene.tissue.shape = "ellipsoid";
  EXPECT_NEAR(initial_size(scene).cells, 4188.79, 0.01);
  scene.tissue.shape = "cylinder";
  EXPECT_NEAR(initial_size(scene).cells, 39269.9, 0.1);
  scene.tissue.shape = "mesh";
  EXPECT_EQ(initial_size(scene).cells, 0.);
  scene.dimension    = 2;
  scene.tissue.shape = "sphere";
  EXPECT_NEAR(initial_size(scene).cells, 1963.50, 0.01);
}


TEST(SceneSize, RefusesWhatDoesNotFit)
{
  const double memory = physical_memory(MPI_COMM_WORLD);
  EXPECT_GT(memory, 1e8);
  EXPECT_LT(memory, 1e15);

  Scene scene;
  check_memory(scene, {1e4, 1e7}, MPI_COMM_WORLD);
  scene.tissue.cell_spacing = 0.01;
  const std::string message = complaint_of(
    [&] { check_memory(scene, initial_size(scene), MPI_COMM_WORLD); });
  expect_parts(message, {"GB", "Cell spacing", "Grid/Spacing"});

  scene.tissue.cell_spacing = 10.;
  scene.grid.spacing        = 0.05;
  EXPECT_THROW(check_memory(scene, initial_size(scene), MPI_COMM_WORLD),
               InputError);
}


TEST(SceneChecks, EvaluateTheExpressionsAtAllCells)
{
  // bad at one cell of the last rank: all ranks must refuse
  const std::string           bad = std::to_string(number_of_ranks() - 1);
  const std::vector<Point<3>> founders(1, Point<3>(this_rank(), 0., 0.));
  const auto                  check = [&](const Scene &scene) {
    return complaint_of(
      [&] { check_at_cells(TissueModel<3>(scene), founders, MPI_COMM_WORLD); });
  };

  Scene scene;
  EXPECT_EQ(check(scene), "");

  scene.material.youngs_modulus = "if(X == " + bad + ", 0, 1)";
  expect_parts(check(scene), {"Material/Young's modulus"});
  scene.material.youngs_modulus = "1";

  scene.growth_law                                = "isotropic";
  scene.keys<IsotropicGrowthParameters>().stretch = "1 - t*(X == " + bad + ")";
  expect_parts(check(scene), {"Growth/Isotropic/Stretch"});
  scene.time.end_time = 0.5;
  EXPECT_EQ(check(scene), "");
  scene.growth_law = "none";

  scene.keys<BodyForceParameters>().force_density = "0; 0; 1/(X - " + bad + ")";
  expect_parts(check(scene), {"Body force/Force density"});
  scene.keys<BodyForceParameters>().force_density = "0; 0; 0";

  scene.keys<CellCycleParameters>().law      = "cell cycle";
  scene.keys<CellCycleParameters>().duration = "1 - 0.95*(X == " + bad + ")";
  expect_parts(check(scene), {"Step"});
}


TEST(SceneChecks, CountTheBoundaryConditions)
{
  Scene      scene;
  const auto set = [&](const std::string &name, const std::string &value) {
    set_condition(scene, name, value);
  };
  const auto check = [&] {
    return check_at_surface(TissueModel<3>(scene), two_faces(), MPI_COMM_WORLD);
  };

  set("Fixed where", "Z < 0");
  set("Slip where", "1");
  set("Slip normal", "0, 0, 2");
  set("Pressure where", "X == 0 && Z > 0");
  set("Pressure", "1/(1 + X)");
  ConditionCounts counts = check();
  EXPECT_EQ(counts.points, 2 * number_of_ranks());
  EXPECT_EQ(counts.fixed, number_of_ranks());
  // fixed wins over slip, slip over pressure
  EXPECT_EQ(counts.acting.at("slip"), number_of_ranks());
  EXPECT_EQ(counts.acting.at("traction"), 0u);
  EXPECT_EQ(counts.acting.at("pressure"), 0u);

  set("Slip where", "Z < 0");
  counts = check();
  EXPECT_EQ(counts.fixed, number_of_ranks());
  EXPECT_EQ(counts.acting.at("slip"), 0u);
  EXPECT_EQ(counts.acting.at("pressure"), 1u);
  set("Slip where", "1");

  set("Slip normal", "1, 0, 0");
  const std::string message = complaint_of(check);
  expect_parts(message, {"Boundary conditions/Slip where"});
  expect_parts(message, {"boundary point"});
  set("Slip where", "");

  set("Displacement", "1/X; 0; 0");
  expect_parts(complaint_of(check), {"Boundary conditions/Displacement"});
}
