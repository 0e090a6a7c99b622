// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "scene/room.h"

/** A held cube of 1000 cells that grows, with nothing to warn of. */
Scene
good_scene()
{
  Scene scene;
  scene.tissue.shape                              = "box";
  scene.tissue.size                               = {100., 100., 100.};
  scene.growth_law                                = "isotropic";
  scene.keys<IsotropicGrowthParameters>().stretch = "1 + 0.1*t";
  scene.keys<FixedParameters>().where             = "Z < -49";
  scene.nitsche.penalty                           = 1000.;
  scene.time.step                                 = 1.;
  scene.time.end_time                             = 4.;
  scene.output.interval                           = 1.;
  return scene;
}

template <int dim>
std::vector<std::string>
warnings_of(const Scene &scene)
{
  scene.check();
  const SurfacePatches<dim> surface =
    seed_surface<dim>(scene.tissue, MPI_COMM_WORLD);
  const TissueModel<dim> model(scene);
  return scene_warnings(model,
                        seed_founders<dim>(scene.tissue, MPI_COMM_WORLD),
                        surface,
                        check_at_surface(model, surface, MPI_COMM_WORLD),
                        MPI_COMM_WORLD);
}

/** Expects a single warning that names this. */
void
expect_warning(const Scene &scene, const std::string &part)
{
  const auto warnings = warnings_of<3>(scene);
  ASSERT_EQ(warnings.size(), 1u)
    << part << " " << (warnings.empty() ? "" : warnings.back());
  expect_parts(warnings[0], {part});
}

TEST(SceneWarnings, AreNoneForAGoodScene)
{
  EXPECT_TRUE(warnings_of<3>(good_scene()).empty());
  Scene flat                         = good_scene();
  flat.dimension                     = 2;
  flat.keys<FixedParameters>().where = "Y < -49";
  EXPECT_TRUE(warnings_of<2>(flat).empty());
}


TEST(SceneWarnings, OfCellsPerGridSpacing)
{
  Scene scene        = good_scene();
  scene.grid.spacing = 30.;
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.grid.spacing = 24.;
  expect_warning(scene, "2.4 cells of 10 um");
  scene.grid.points_per_cell = 2;
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.grid.points_per_cell = 1;
  scene.grid.spacing         = 15.;
  expect_warning(scene, "1.5 cells");
}


// The length of cells follows from their volumes, wherever these come from.
TEST(SceneWarnings, OfCellsInAnotherUnit)
{
  Scene scene        = good_scene();
  scene.tissue.shape = "points";
  for (const auto &[length, is_said] : {std::pair(0.49, true),
                                        std::pair(0.51, false),
                                        std::pair(490., false),
                                        std::pair(510., true)})
    {
      std::ostringstream text;
      text << "x,y,z\n0,0,0\n" << length << ",0,0\n";
      const TemporaryFile file(".csv", text.str());
      scene.tissue.points_file                = file.path;
      scene.tissue.cell_spacing               = length;
      scene.grid.spacing                      = 3. * length;
      scene.keys<FixedParameters>().where     = "";
      const std::vector<std::string> warnings = warnings_of<3>(scene);
      EXPECT_EQ(std::any_of(warnings.begin(),
                            warnings.end(),
                            [](const std::string &one) {
                              return one.find("another unit") !=
                                     std::string::npos;
                            }),
                is_said)
        << length;
    }
}


TEST(SceneWarnings, OfThinTissue)
{
  Scene scene                         = good_scene();
  scene.tissue.size                   = {100., 100., 50.};
  scene.keys<FixedParameters>().where = "Z < -24";
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.tissue.size                   = {100., 100., 40.};
  scene.keys<FixedParameters>().where = "Z < -19";
  expect_warning(scene, "40 um wide");
}


TEST(SceneWarnings, OfBoundaryPointsFarApart)
{
  Scene scene                  = good_scene();
  scene.tissue.boundary_points = 96; // 4 x 4 a face: 25 um apart
  scene.tissue.refine_surface  = false;
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  set_condition(scene, "Slip where", "X < -49");
  expect_warning(scene, "25 um apart");
  scene.tissue.refine_surface = true;
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.tissue.refine_surface  = false;
  scene.tissue.boundary_points = 150;
  EXPECT_TRUE(warnings_of<3>(scene).empty());
}


TEST(SceneWarnings, OfLongSteps)
{
  Scene scene = good_scene();
  scene.keys<IsotropicGrowthParameters>().stretch =
    "1 + 0.2*t*(X > 44)"; // one layer of cells
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.keys<IsotropicGrowthParameters>().stretch = "1 + 0.21*t*(X > 44)";
  expect_warning(scene, "1.21");
  scene.keys<IsotropicGrowthParameters>().stretch =
    "if(t > 2.5 && X > 44, 0.5, 1)"; // withering
  expect_warning(scene, "up to 2;");
  scene.keys<IsotropicGrowthParameters>().stretch = "1 + 0.3*t";
  scene.keys<FixedParameters>().where             = "";
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.keys<IsotropicGrowthParameters>().stretch =
    "if(t == 2, log(-1), 1)"; // the run says so
  EXPECT_TRUE(warnings_of<3>(scene).empty());
}


TEST(SceneWarnings, OfStepsOfTheCellCycle)
{
  Scene scene                                = good_scene();
  scene.growth_law                           = "none";
  scene.keys<IsotropicGrowthParameters>()    = IsotropicGrowthParameters();
  scene.keys<CellCycleParameters>().law      = "cell cycle";
  scene.keys<CellCycleParameters>().duration = "if(X > 44, 4, 5)";
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.keys<CellCycleParameters>().duration = "if(X > 44, 3, 5)";
  expect_warning(scene, "0.333333 of the shortest cell cycle");
  scene.keys<CellCycleParameters>().where = "X < 44";
  EXPECT_TRUE(warnings_of<3>(scene).empty());
}


TEST(SceneWarnings, OfTheMaterial)
{
  Scene scene                   = good_scene();
  scene.material.poissons_ratio = 0.49;
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.material.volumetric_strain = "pointwise";
  expect_warning(scene, "Material/Poisson's ratio = '0.49'");
}


TEST(SceneWarnings, OfAClampAllAroundThatGivesWay)
{
  Scene scene           = good_scene();
  scene.nitsche.form    = "unsymmetric";
  scene.nitsche.penalty = 20.;
  EXPECT_TRUE(warnings_of<3>(scene).empty()); // there is a free surface
  scene.keys<FixedParameters>().where = "1";
  expect_warning(scene, "Nitsche penalty = '20 E/h'");
  scene.nitsche.penalty = 1000.;
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.nitsche.form = "symmetric";
  EXPECT_TRUE(warnings_of<3>(scene).empty());
}


TEST(SceneWarnings, OfFormerNames)
{
  Scene scene   = good_scene();
  scene.renamed = {"scene.prm:3: the key 'A' is called 'B' today"};
  expect_warning(scene, "Warning: scene.prm:3");
}


TEST(SceneWarnings, OfContractionsThatJump)
{
  Scene scene                                   = good_scene();
  scene.keys<ContractionParameters>().direction = "1; 0; 0";
  scene.keys<ContractionParameters>().stretch   = "1 - 0.1*t*(X > 0)";
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.keys<ContractionParameters>().stretch = "1 - 0.11*min(t, 2)*(X > 0)";
  expect_warning(scene, "changes by up to 0.11;");
  // At the start, too.
  scene.keys<ContractionParameters>().stretch = "if(X > 0, 1.2, 1)";
  expect_warning(scene, "by up to 0.2;");
}


TEST(SceneWarnings, OfANarrowLumen)
{
  Scene scene               = good_scene();
  scene.tissue.shape        = "sphere";
  scene.tissue.radius       = 300.;
  scene.tissue.inner_radius = 60.;
  scene.grid.spacing        = 38.;
  set_condition(scene, "Lumen where", "X^2 + Y^2 + Z^2 < 80^2");
  set_condition(scene, "Lumen volume", "1 + t");
  EXPECT_TRUE(warnings_of<3>(scene).empty());
  scene.grid.spacing = 44.;
  expect_warning(scene, "Boundary conditions/Lumen where");
}
