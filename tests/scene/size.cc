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


TEST(SceneSize, SolvesTheRenewalEquation)
{
  EXPECT_EQ(expected_cells(1., 1., 0.5, false), 1.);
  EXPECT_EQ(expected_cells(1., 0., 100., false), 1.);
  EXPECT_EQ(expected_cells(1., 0., 100., true), 2.);
  // one wait: divided with probability 1 - exp(-Lambda (t - T/2))
  EXPECT_NEAR(expected_cells(2., 3., 1.4, false), 2. - std::exp(-1.2), 1e-14);
  // no waits: all divide at T/2, 3T/2, ...
  for (const auto &[t, n] : {std::pair(0.4, 1.),
                             std::pair(0.6, 2.),
                             std::pair(1.4, 2.),
                             std::pair(3.6, 16.)})
    {
      EXPECT_NEAR(expected_cells(1., 1e9, t, true), n, 1e-6);
      EXPECT_NEAR(expected_cells(1., 1e9, t, false), n, 1e-6);
    }
  // at long times exponential: 2 exp(-rT) Lambda/(Lambda + r) = 1
  for (const double T : {0.5, 1., 2.})
    for (const double Lambda : {0.1, 0.3, 1.})
      {
        const double r = std::log(expected_cells(T, Lambda, 60., false) /
                                  expected_cells(T, Lambda, 50., false)) /
                         10.;
        EXPECT_NEAR(2. * std::exp(-r * T) * Lambda / (Lambda + r), 1., 1e-6)
          << T << ' ' << Lambda;
      }
  EXPECT_GT(expected_cells(1e-9, 1e9, 1., false), 1e300);
}


TEST(SceneSize, CountsDescendants)
{
  Scene                       scene;
  const std::vector<Point<3>> founders = {Point<3>(-1., 0., 0.),
                                          Point<3>(1., 0., 0.)};
  const double                n        = number_of_ranks();
  const auto                  size     = [&] {
    return expected_size(scene, founders, MPI_COMM_WORLD);
  };

  EXPECT_DOUBLE_EQ(size().cells, 2. * n);
  EXPECT_DOUBLE_EQ(size().volume, 2000. * n);

  scene.growth_law                                = "isotropic";
  scene.keys<IsotropicGrowthParameters>().stretch = "1 + t*(X > 0)";
  EXPECT_DOUBLE_EQ(size().volume, 9000. * n);

  scene.growth_law                        = "none";
  scene.keys<CellCycleParameters>().law   = "cell cycle";
  scene.keys<CellCycleParameters>().where = "X > 0";
  scene.time.end_time                     = 10.;
  const double many = 1. + expected_cells(1., 1., 10., false);
  EXPECT_NEAR(size().cells, many * n, 1e-9 * many * n);

  scene.time.stop_at_cells = 10 * number_of_ranks();
  EXPECT_DOUBLE_EQ(size().cells, 20. * n);
  scene.keys<CellCycleParameters>().size_checkpoint = "0.8";
  EXPECT_DOUBLE_EQ(size().cells, 2. * n);
}


/** Growth that depends on the cells' state is taken for that of cells which
 *  nothing presses: then it is known. */
TEST(SceneSize, LetsCellsGrowFreely)
{
  const TemporaryFile empty(".prm", "");
  const auto          ratio = [&](std::vector<std::string> settings) {
    for (const char *const setting : {"Tissue/Shape=box",
                                      "Tissue/Size=100, 100, 100",
                                      "Time/End time=4",
                                      "Time/Step=0.25"})
      settings.push_back(setting);
    const Scene scene = Scene::read(empty.path, settings);
    const auto  founders = seed_founders<3>(scene.tissue, MPI_COMM_WORLD);
    const auto  found =
      free_growth(scene,
                  founders,
                  seed_surface<3>(scene.tissue, MPI_COMM_WORLD),
                  MPI_COMM_WORLD);
    std::optional<double> free;
    if (found && !found->known_before)
      free = found->mean;
    if (free)
      {
        const auto without = estimated_size(scene, founders, MPI_COMM_WORLD);
        const auto with =
          estimated_size(scene, founders, MPI_COMM_WORLD, 0, free);
        EXPECT_EQ(with.cells, without.cells);
        EXPECT_GT(with.unknowns, without.unknowns);
        EXPECT_GT(with.seconds, without.seconds);
      }
    return free.value_or(0.);
  };
  const std::string rate = "Growth/Law=rate";
  EXPECT_EQ(ratio({}), 0.);
  EXPECT_EQ(ratio({rate, "Growth/Rate/Rate=0.5*t"}), 0.);
  // With the memory of the predictor, and without; in the cycle, too.
  for (const char *const predictor : {"true", "false"})
    for (const char *const law : {"none", "cell cycle"})
      EXPECT_NEAR(ratio({rate,
                         "Growth/Rate/Rate=0.5*max(0, 1 - pressure/1)",
                         std::string("Growth/Rate/Predictor=") + predictor,
                         std::string("Proliferation/Law=") + law}),
                  std::exp(2.),
                  1e-3 * std::exp(2.));
  // Half of the cells; until they are twice as large: in the step after that
  // half a step is taken back.
  EXPECT_NEAR(ratio({rate,
                     "Growth/Rate/Rate=0.25*(type == leaf)*(growth < 1.999)",
                     "Cell types/Names=stem, leaf",
                     "Cell types/leaf/Where=X > 0"}),
              0.5 * (1. + std::exp(0.25 * 2.875)),
              1e-9);
  // A contraction stands left of the law.
  EXPECT_NEAR(ratio({"Growth/Law=isotropic",
                     "Growth/Isotropic/Stretch=1 + 0.1*t*(J_e > 0)",
                     "Contraction/Stretch=1 - 0.1*t",
                     "Contraction/Direction=1; 0; 0"}),
              std::pow(1.4, 3),
              1e-9);
}


TEST(SceneSize, KnowsHowUnequallyCellsGrow)
{
  const TemporaryFile empty(".prm", "");
  const Scene         scene = Scene::read(empty.path,
                                          {"Tissue/Shape=box",
                                           "Tissue/Size=100, 100, 100",
                                           "Time/End time=2",
                                           "Time/Step=0.25",
                                           "Growth/Law=rate",
                                           "Growth/Rate/Rate=0.5*(X > 0)"});
  const auto          growth =
    free_growth(scene,
                seed_founders<3>(scene.tissue, MPI_COMM_WORLD),
                seed_surface<3>(scene.tissue, MPI_COMM_WORLD),
                MPI_COMM_WORLD);
  ASSERT_TRUE(growth);
  EXPECT_TRUE(growth->known_before);
  EXPECT_NEAR(growth->least, 1., 1e-12);
  EXPECT_NEAR(growth->most, std::exp(1.), 1e-9);
  EXPECT_NEAR(growth->mean, 0.5 * (1. + std::exp(1.)), 1e-9);
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
  expect_parts(message, {"GB", "Cell spacing", "End time", "Stop at cells"});

  scene.tissue.cell_spacing = 10.;
  scene.grid.spacing        = 0.05;
  EXPECT_THROW(check_memory(scene, initial_size(scene), MPI_COMM_WORLD),
               InputError);
}


TEST(SceneSize, EstimatesTheMatrixOfTheHalfFixedSphere)
{
  // measured: 840 k entries for 2,904 unknowns at h = 50; the box around the
  // tissue has more, and there are three copies of 12 bytes an entry
  Scene        scene;
  const double bytes = estimated_memory(scene, initial_size(scene));
  EXPECT_GT(bytes, 3. * 12. * 840e3);
  EXPECT_LT(bytes, 1e9);
  scene.grid.spacing = 25.;
  EXPECT_GT(estimated_memory(scene, initial_size(scene)), bytes);
}


TEST(SceneSize, EstimatesRuns)
{
  Scene scene;
  scene.tissue.shape                              = "box";
  scene.growth_law                                = "isotropic";
  scene.keys<IsotropicGrowthParameters>().stretch = "1 + t";
  scene.time.step                                 = 0.1;
  const auto size = [&](const unsigned int n_unknowns) {
    return estimated_size(scene,
                          seed_founders<3>(scene.tissue, MPI_COMM_WORLD),
                          MPI_COMM_WORLD,
                          n_unknowns);
  };
  const SizeEstimate grown = size(648);
  EXPECT_EQ(grown.cells, 8000.);
  EXPECT_EQ(grown.unknowns_at_start, 648.);
  EXPECT_NEAR(grown.unknowns,
              648. * 1000. / 216.,
              1e-9); // (8 + 2)^3, (4 + 2)^3
  EXPECT_EQ(grown.steps, 10.);
  EXPECT_NEAR(size(0).unknowns_at_start, 648., 1e-9);

  // twice the steps, twice the time; finer grids and a direct solver cost more
  scene.time.step = 0.05;
  EXPECT_NEAR(size(648).seconds, 2. * grown.seconds, 1e-9);
  EXPECT_EQ(size(648).memory, grown.memory);
  EXPECT_GT(size(6480).seconds, size(648).seconds);
  EXPECT_GT(size(6480).memory, size(648).memory);
  const double iterative     = size(6480).memory;
  scene.solver.linear_solver = "direct";
  EXPECT_GT(size(6480).memory, iterative);
}


TEST(SceneChecks, EvaluateTheExpressionsAtAllCells)
{
  // bad at one cell of the last rank: all ranks must refuse
  const std::string           bad = std::to_string(number_of_ranks() - 1);
  const std::vector<Point<3>> founders(1, Point<3>(this_rank(), 0., 0.));
  const auto                  check = [&](const Scene &scene) {
    return complaint_of(
      [&] { check_at_cells(scene, founders, MPI_COMM_WORLD); });
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
  auto      &fixed    = scene.keys<FixedParameters>();
  auto      &slip     = scene.keys<SlipParameters>();
  auto      &pressure = scene.keys<PressureParameters>();
  const auto check    = [&] {
    return check_at_surface(scene, two_faces(), MPI_COMM_WORLD);
  };

  fixed.where            = "Z < 0";
  slip.where             = "1";
  slip.normal            = "0, 0, 2";
  pressure.where         = "X == 0 && Z > 0";
  pressure.pressure      = "1/(1 + X)";
  ConditionCounts counts = check();
  EXPECT_EQ(counts.points, 2 * number_of_ranks());
  EXPECT_EQ(counts.fixed, number_of_ranks());
  // fixed wins over slip, slip over pressure
  EXPECT_EQ(counts.acting.at("slip"), number_of_ranks());
  EXPECT_EQ(counts.acting.at("traction"), 0u);
  EXPECT_EQ(counts.acting.at("pressure"), 0u);

  slip.where = "Z < 0";
  counts     = check();
  EXPECT_EQ(counts.fixed, number_of_ranks());
  EXPECT_EQ(counts.acting.at("slip"), 0u);
  EXPECT_EQ(counts.acting.at("pressure"), 1u);
  slip.where = "1";

  slip.normal               = "1, 0, 0";
  const std::string message = complaint_of(check);
  expect_parts(message, {"Boundary conditions/Slip where"});
  expect_parts(message, {"boundary point"});
  slip.where = "";

  fixed.displacement = "1/X; 0; 0";
  expect_parts(complaint_of(check), {"Boundary conditions/Displacement"});
}
