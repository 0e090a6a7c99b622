// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "scene/room.h"

/** Writes a file. @return its path */
std::string
written(const ScratchDirectory &directory,
        const std::string      &name,
        const std::string      &text)
{
  write(directory / name, text);
  return directory / name;
}

Scene
read(const std::string &text, const std::vector<std::string> &overrides = {})
{
  const ScratchDirectory directory(MPI_COMM_SELF);
  return Scene::read(written(directory, "scene.prm", text), overrides);
}

/** What reading and checking says about a scene. */
std::string
complaint(const std::string              &text,
          const std::vector<std::string> &overrides = {})
{
  return complaint_of([&] { read(text, overrides).check(); });
}


TEST(Scene, ReadsEveryKindOfKey)
{
  const Scene scene = read("set Dimension = 2\n"
                           "subsection Proliferation  # a comment\n"
                           "  set Law = cell cycle\n"
                           "\tsubsection Cell cycle\n"
                           "    set Duration = 1 + \\\n"
                           "                   0.1*X\n"
                           "    set Axis follows rotation = true\n"
                           "  end\n"
                           "end\n"
                           "subsection Output\r\n"
                           "  set Formats = vtu, csv\r\n"
                           "end\r\n"
                           "subsection Grid\n"
                           "  set Offset = 1, 2.5\n"
                           "end");
  EXPECT_EQ(scene.dimension, 2u);
  EXPECT_TRUE(scene.cells_divide());
  EXPECT_EQ(scene.keys<CellCycleParameters>().duration, "1 + 0.1*X");
  EXPECT_TRUE(scene.division.axis_follows_rotation);
  EXPECT_EQ(scene.output.formats.value(),
            (std::vector<std::string>{"vtu", "csv"}));
  EXPECT_EQ(scene.grid.offset.value(), (std::vector<double>{1., 2.5}));
  EXPECT_NO_THROW(scene.check());
}


TEST(Scene, IsOverriddenFromTheCommandLine)
{
  const Scene scene = read("subsection Time\n set End time = 3\nend",
                           {"Time/End time=4",
                            "Time / End time = 5",
                            "Growth/Law=isotropic",
                            "Growth/Isotropic/Stretch=if(X == 0, 1, 2)"});
  EXPECT_EQ(scene.time.end_time, 5.);
  EXPECT_EQ(scene.keys<IsotropicGrowthParameters>().stretch,
            "if(X == 0, 1, 2)");
  EXPECT_EQ(scene.as_written.at("Time/End time"), "5");
}


TEST(Scene, IncludesFiles)
{
  const ScratchDirectory directory(MPI_COMM_SELF);
  written(directory, "grid.prm", "subsection Grid\n set Spacing = 33.3\nend");
  const Scene scene =
    Scene::read(written(directory, "scene.prm", "include grid.prm"), {});
  EXPECT_EQ(scene.grid.spacing, 33.3);

  const std::string circle =
    written(directory, "circle.prm", "include circle.prm");
  EXPECT_THROW(Scene::read(circle, {}), InputError);
  expect_parts(complaint("\ninclude absent.prm"),
               {"scene.prm:2", "absent.prm", "can be read", "name"});
}


TEST(Scene, PrintsParametersThatReadBackExactly)
{
  const std::string third = "0.333333333333333315";
  Scene             scene =
    read("", {"Time/Step=" + third, "Tissue/Center=" + third + ", 2, 3"});
  ASSERT_EQ(scene.time.step, 1. / 3.);

  const Scene again = read(scene.parameters());
  EXPECT_EQ(again.time.step, 1. / 3.);
  EXPECT_EQ(again.tissue.center.value(),
            (std::vector<double>{1. / 3., 2., 3.}));
  EXPECT_EQ(again.parameters(), scene.parameters());
  EXPECT_EQ(again.output_directory.value(), scene.output_directory.value());

  // what has been changed since is printed as it is now
  scene.time.step     = 0.25;
  scene.tissue.radius = 77.;
  const Scene changed = read(scene.parameters());
  EXPECT_EQ(changed.time.step, 0.25);
  EXPECT_EQ(changed.tissue.radius, 77.);
  EXPECT_EQ(changed.tissue.center.value()[0], 1. / 3.);
}


TEST(Scene, NamesItsDirectory)
{
  const ScratchDirectory directory(MPI_COMM_SELF);
  const std::string      file  = written(directory, "fig-4e-0.95.prm", "");
  const Scene            scene = Scene::read(file, {});
  EXPECT_EQ(scene.output_directory, "output/fig-4e-0.95");
  EXPECT_EQ(scene.file, file);
  EXPECT_FALSE(scene.replace);
  EXPECT_EQ(Scene::read(file, {"Output directory="}).output_directory,
            "output/fig-4e-0.95");
  EXPECT_EQ(Scene::read(file, {"Output directory=a b"}).output_directory,
            "a b");
}


TEST(Scene, RefusesBadFiles)
{
  try
    {
      Scene::read("absent.prm", {});
      ADD_FAILURE();
    }
  catch (const InputError &error)
    {
      expect_parts(error.what(), {"absent.prm", "can be read", "name"});
    }
  EXPECT_THROW(Scene::read("/", {}), InputError);

  for (const auto &[text, parts] :
       std::vector<std::pair<std::string, std::vector<std::string>>>{
         {"subsection Grid\n  set Spacng = 50\nend",
          {"scene.prm:2",
           "Grid/Spacng",
           "'50'",
           "Did you mean 'Grid/Spacing'"}},
         {"set Dimension = 3\nset Dimension = " + std::string(20000, '3'),
          {"scene.prm:2", "333...", "10000 characters"}},
         {"set Dimension = 3 \x01 2", {"scene.prm:1", "3 \\x01 2"}},
         {std::string("set Dimension\0 = 3", 19), {"scene.prm:1", "key"}},
         {std::string(100000, '('), {"scene.prm:1", "10000 characters"}},
         {"set " + std::string(5000, 'a') + " = 1", {"scene.prm:1", "unknown"}},
         {"\nsubsection Grid\n" +
            boost::join(std::vector<std::string>(50, "subsection Grid"), "\n"),
          {"scene.prm:22", "'end'"}},
         {"include " + std::string(5000, 'a'), {"scene.prm:1", "can be read"}},
         {"include /dev/zero", {"scene.prm:1", "can be read"}},
         {"set Spacing = 50",
          {"scene.prm:1", "'50'", "Did you mean 'Grid/Spacing'"}},
         {"\nsubsection Gird\nend",
          {"scene.prm:2", "Gird", "section", "Did you mean 'Grid'"}},
         {"subsection Time\n  set step = 1\nend",
          {"Time/step", "Did you mean 'Time/Step'"}},
         {"set Completely different = 1",
          {"unknown key", "Completely different", "morula keys WORD"}},
         {"Spacing = 50",
          {"scene.prm:1",
           "Spacing = 50",
           "'set Key = value'",
           "begins with 'set'"}},
         {"sett Spacing = 50", {"scene.prm:1", "Did you mean 'set'?"}},
         {"subsecton Grid", {"scene.prm:1", "Did you mean 'subsection'?"}},
         {"Grid\nend", {"scene.prm:1", "begins with 'subsection'"}},
         {"subsection Grid\n  set Spacing 50\nend",
          {"scene.prm:2", "set Spacing 50", "Put '='"}},
         {"subsection Grid\n  set Spacing = 50\n",
          {"scene.prm:1: subsection 'Grid'",
           "closed",
           "Add the missing 'end'",
           "ends with line 2"}},
         {"subsection Grid\nend\nend", {"scene.prm:3", "remove the 'end'"}},
         {"end of file", {"scene.prm:1", "end of file", "Correct the line"}},
         {"subsection Grid\n  set Spacing = 50 um\nend",
          {"scene.prm:2", "Grid/Spacing", "50 um", "a number", "um"}},
         {"subsection Grid\n  set Spacing = {50}\nend",
          {"scene.prm:2", "Grid/Spacing", "{50}", "a number"}}})
    expect_parts(complaint(text), parts);
}


TEST(Scene, ReadsFilesOfAnyEditor)
{
  EXPECT_EQ(read("\xEF\xBB\xBFset Dimension = 2").dimension, 2u);
  EXPECT_EQ(read("set Dimension = 2\r\nset Random seed = 3\r\n").dimension, 2u);
  EXPECT_EQ(
    read("#" + std::string(20000, '-') + "\nset Dimension = 2").dimension, 2u);
}


TEST(Scene, MayHaveAnEffectSwitchedOffOnPurpose)
{
  EXPECT_EQ(complaint("", {"Growth/Isotropic/Stretch=1+t", "Growth/Law=none"}),
            "");
  EXPECT_EQ(complaint("",
                      {"Boundary conditions/Traction where=",
                       "Boundary conditions/Traction=1; 0; 0"}),
            "");
  // the default, written otherwise
  EXPECT_EQ(complaint("",
                      {"Growth/Isotropic/Stretch=1.0",
                       "Boundary conditions/Displacement=0;0;0"}),
            "");
}


TEST(Scene, HasShorterVectorsInThePlane)
{
  const std::string bc = "Boundary conditions/";
  EXPECT_EQ(complaint("",
                      {"Dimension=2",
                       "Tissue/Center=0, 0",
                       "Grid/Offset=1, 2",
                       bc + "Fixed where=Y <= 0",
                       bc + "Displacement=t; 0",
                       "Body force/Force density=0; -1; 0"}),
            "");
}
