// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/effects/growth/isotropic.h>
#include <morula/scene/scene.h>

#include <boost/algorithm/string.hpp>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/complaint.h"

using namespace Morula;

namespace
{
  /** A directory that is removed at the end of a test. */
  class ScratchDirectory
  {
  public:
    ScratchDirectory()
      : path(std::filesystem::temp_directory_path() /
             ("morula-scene-" + std::to_string(getpid())))
    {
      std::filesystem::create_directories(path);
    }

    ~ScratchDirectory()
    {
      std::filesystem::remove_all(path);
    }

    std::string
    write(const std::string &name, const std::string &text) const
    {
      std::ofstream(path / name) << text;
      return (path / name).string();
    }

  private:
    const std::filesystem::path path;
  };

  Scene
  read(const std::string &text, const std::vector<std::string> &overrides = {})
  {
    const ScratchDirectory directory;
    return Scene::read(directory.write("scene.prm", text), overrides);
  }

  /** What reading and checking says about a scene. */
  std::string
  complaint(const std::string              &text,
            const std::vector<std::string> &overrides = {})
  {
    return complaint_of([&] { read(text, overrides).check(); });
  }


  struct BadInput
  {
    std::string              override_text;
    std::vector<std::string> parts; // key, value, limit, remedy
  };
} // namespace


TEST(Scene, HasTheDefaultsOfTheContract)
{
  const Scene                        scene;
  std::map<std::string, std::string> defaults;
  for (const AnyKey *key : scene.list())
    {
      defaults[key->path()] = key->default_text();
      EXPECT_FALSE(key->documentation().empty()) << key->path();
    }
  const std::map<std::string, std::string> contract = {
    {"Dimension", "3"},
    {"Method", "consistent"},
    {"Output directory", ""},
    {"Random seed", "1"},
    {"Time/End time", "1"},
    {"Time/Step", "0.05"},
    {"Time/Smallest step", "0.0001"},
    {"Time/Stop at cells", "0"},
    {"Tissue/Shape", "sphere"},
    {"Tissue/Center", "0, 0, 0"},
    {"Tissue/Radius", "250"},
    {"Tissue/Size", "200, 200, 200"},
    {"Tissue/Surface mesh", ""},
    {"Tissue/Points file", ""},
    {"Tissue/Cell spacing", "10"},
    {"Tissue/Lattice offset", "0, 0, 0"},
    {"Tissue/Boundary points", "0"},
    {"Grid/Spacing", "50"},
    {"Grid/Offset", "0, 0, 0"},
    {"Grid/Occupation parameter", "0.85"},
    {"Grid/Extension", "true"},
    {"Material/Young's modulus", "1.0"},
    {"Material/Poisson's ratio", "0.4"},
    {"Material/Energy per", "initial volume"},
    {"Growth/Law", "none"},
    {"Growth/Isotropic/Stretch", "1"},
    {"Proliferation/Law", "none"},
    {"Proliferation/Cell cycle/Start", "waiting"},
    {"Proliferation/Cell cycle/Duration", "1"},
    {"Proliferation/Cell cycle/G0 exit rate", "1"},
    {"Proliferation/Cell cycle/Size checkpoint", "0"},
    {"Proliferation/Cell cycle/Where", "1"},
    {"Proliferation/Cell cycle/Division axis", "random"},
    {"Proliferation/Cell cycle/Fixed axis", "0, 0, 1"},
    {"Proliferation/Cell cycle/Axis follows rotation", "false"},
    {"Boundary conditions/Fixed where", ""},
    {"Boundary conditions/Displacement", "0; 0; 0"},
    {"Boundary conditions/Slip where", ""},
    {"Boundary conditions/Slip normal", ""},
    {"Boundary conditions/Traction where", ""},
    {"Boundary conditions/Traction", "0; 0; 0"},
    {"Boundary conditions/Pressure where", ""},
    {"Boundary conditions/Pressure", "0"},
    {"Boundary conditions/Nitsche penalty", "20"},
    {"Body force/Force density", "0; 0; 0"},
    {"Solver/Newton tolerance", "1e-06"},
    {"Solver/Linear solver", "automatic"},
    {"Output/Interval", "0.25"},
    {"Output/Formats", "vtu"},
    {"Output/Snapshot interval", "0"}};
  for (const auto &[path, value] : contract)
    {
      ASSERT_EQ(defaults.count(path), 1u) << path;
      EXPECT_EQ(defaults.at(path), value) << path;
    }
  EXPECT_EQ(complaint(""), "");
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
  EXPECT_EQ(scene.output.formats, (std::vector<std::string>{"vtu", "csv"}));
  EXPECT_EQ(scene.grid.offset, (std::vector<double>{1., 2.5}));
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
  const ScratchDirectory directory;
  directory.write("grid.prm", "subsection Grid\n set Spacing = 33.3\nend");
  const Scene scene =
    Scene::read(directory.write("scene.prm", "include grid.prm"), {});
  EXPECT_EQ(scene.grid.spacing, 33.3);

  const std::string circle =
    directory.write("circle.prm", "include circle.prm");
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
  EXPECT_EQ(again.tissue.center, (std::vector<double>{1. / 3., 2., 3.}));
  EXPECT_EQ(again.parameters(), scene.parameters());
  EXPECT_EQ(again.output_directory.value(), scene.output_directory.value());

  // what has been changed since is printed as it is now
  scene.time.step     = 0.25;
  scene.tissue.radius = 77.;
  const Scene changed = read(scene.parameters());
  EXPECT_EQ(changed.time.step, 0.25);
  EXPECT_EQ(changed.tissue.radius, 77.);
  EXPECT_EQ(changed.tissue.center[0], 1. / 3.);
}


TEST(Scene, NamesItsDirectory)
{
  const ScratchDirectory directory;
  const std::string      file  = directory.write("fig-4e-0.95.prm", "");
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
         {"set Dimension = 3 \x01 2",
          {"scene.prm:1", "Character 19", "scene?"}},
         {std::string("set Dimension\0 = 3", 19), {"scene.prm:1", "printed"}},
         {std::string(100000, '('), {"scene.prm:1", "10000 characters"}},
         {"set " + std::string(5000, 'a') + " = 1", {"scene.prm:1", "exists"}},
         {"\nsubsection Grid\n" +
            boost::join(std::vector<std::string>(50, "subsection Grid"), "\n"),
          {"scene.prm:22", "'end'"}},
         {"include " + std::string(5000, 'a'), {"scene.prm:1", "can be read"}},
         {"include /dev/zero", {"/dev/zero:1", "scene?"}},
         {"set Spacing = 50",
          {"scene.prm:1", "'50'", "Did you mean 'Grid/Spacing'"}},
         {"\nsubsection Gird\nend",
          {"scene.prm:2", "Gird", "section", "Did you mean 'Grid'"}},
         {"subsection Time\n  set step = 1\nend",
          {"Time/step", "Did you mean 'Time/Step'"}},
         {"set Completely different = 1",
          {"Completely different", "a key that exists", "--parameters"}},
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
          {"scene.prm:1: subsection = 'Grid'",
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


TEST(Scene, RefusesNumbersThatAreNotFinite)
{
  for (const std::string value : {"inf", "-inf", "nan", "1e999"})
    for (const std::string key : {"Time/End time",
                                  "Grid/Spacing",
                                  "Tissue/Radius",
                                  "Boundary conditions/Nitsche penalty"})
      expect_parts(complaint("", {key + "=" + value}),
                   {key, "'" + value + "'", "number"});
  expect_parts(complaint("", {"Grid/Offset=0, inf, 0"}),
               {"Grid/Offset", "inf"});
  expect_parts(complaint("", {"-s\x01=3"}), {"-s", "printed"});
}


TEST(Scene, RefusesBadValues)
{
  const std::string cycle = "Proliferation/Cell cycle/";
  const std::string bc    = "Boundary conditions/";
  for (const auto &[text, parts] : std::vector<BadInput>{
         {"Grid/Spacing", {"-s", "Grid/Spacing", "Put '='"}},
         {"Grid/Spacng=1",
          {"-s", "Grid/Spacng", "Did you mean 'Grid/Spacing'"}},
         {"Grid/Extension/Spacing=1", {"'Grid/Spacing'"}},
         {"Grid/Spacing=-5", {"Grid/Spacing", "'-5'", "> 0", "Choose"}},
         {"Grid/Spacing=0", {"Grid/Spacing", "'0'", "> 0", "Choose"}},
         {"Grid/Spacing=nan", {"Grid/Spacing", "'nan'", "a number", "Correct"}},
         {"Grid/Spacing=1e999", {"Grid/Spacing", "a number", "Correct"}},
         {"Grid/Offset=1", {"Grid/Offset", "'1'", "2 to 3", "Correct"}},
         {"Grid/Offset=1, 2", {"Grid/Offset", "1, 2", "3 numbers", "Write"}},
         {"Grid/Occupation parameter=1.1",
          {"Grid/Occupation parameter", "'1.1'", "<= 1", "0.85"}},
         {"Grid/Extension=maybe",
          {"Grid/Extension", "maybe", "true or false", "Correct"}},
         {"Dimension=4", {"Dimension", "'4'", "2 to 3", "Correct"}},
         {"Time/End time=0", {"Time/End time", "'0'", "> 0", "Choose"}},
         {"Time/Step=-1", {"Time/Step", "'-1'", "> 0", "Choose"}},
         {"Time/Smallest step=1",
          {"Time/Smallest step", "'1'", "<= Time/Step = 0.05", "Lower"}},
         {"Time/Stop at cells=1.5",
          {"Time/Stop at cells", "1.5", "integer >= 0", "Correct"}},
         {"Material/Poisson's ratio=0.5",
          {"Material/Poisson's ratio", "'0.5'", "< 0.5", "0.49"}},
         {"Material/Poisson's ratio=-1",
          {"Material/Poisson's ratio", "'-1'", "> -1", "0.49"}},
         {"Material/Young's modulus=0",
          {"Material/Young's modulus", "'0'", "> 0", "positive"}},
         {"Material/Energy per=volume",
          {"Material/Energy per", "volume", "initial volume, grown volume"}},
         {"Growth/Law=isotropc",
          {"Growth/Law", "isotropc", "none, isotropic", "Correct"}},
         {"Growth/Isotropic/Stretch=1+t",
          {"Growth/Isotropic/Stretch", "1+t", "Set Growth/Law = isotropic"}},
         {cycle + "Duration=2",
          {cycle + "Duration", "'2'", "Set Proliferation/Law = cell cycle"}},
         {bc + "Fixed where=Z <=",
          {bc + "Fixed where", "Z <=", "muParser", "character 5"}},
         {bc + "Fixed where=Z <= t", {bc + "Fixed where", "remove t"}},
         {bc + "Displacement=0; 0; 1",
          {bc + "Displacement", "0; 0; 1", "Say where", bc + "Fixed where"}},
         {bc + "Traction=1; 0; 0", {bc + "Traction where", "Say where"}},
         {bc + "Traction=1; 0", {bc + "Traction", "3 expressions"}},
         {bc + "Pressure=1", {bc + "Pressure where", "Say where"}},
         {bc + "Slip normal=0, 0, 1", {bc + "Slip where", "Say where"}},
         {bc + "Slip normal=0, 0, 0", {bc + "Slip normal", "not all zero"}},
         {bc + "Nitsche penalty=0", {bc + "Nitsche penalty", "> 0", "1e3"}},
         {"Body force/Force density=0, 0, 1",
          {"Body force/Force density", "0, 0, 1", "3 expressions", "';'"}},
         {"Solver/Newton tolerance=1",
          {"Solver/Newton tolerance", "'1'", "< 1", "1e-6"}},
         {"Output/Formats=vtu, none",
          {"Output/Formats", "vtu, none", "none alone", "Remove"}},
         {"Output/Formats=csv, csv", {"Output/Formats", "once", "Remove"}},
         {"Output/Formats=vtk", {"Output/Formats", "vtk", "vtu, csv, none"}},
         {"Output/Interval=-1", {"Output/Interval", "'-1'", ">= 0", "Correct"}},
         {"Tissue/Cell spacing=0", {"Tissue/Cell spacing"}}})
    expect_parts(complaint("", {text}), parts);
}


TEST(Scene, RefusesBadCellCycles)
{
  const std::string cycle = "Proliferation/Cell cycle/";
  for (const auto &[text, parts] : std::vector<BadInput>{
         {cycle + "Duration=0", {cycle + "Duration", "'0'", "> 0"}},
         {cycle + "G0 exit rate=-1", {cycle + "G0 exit rate", "'-1'", ">= 0"}},
         {cycle + "Where=X >", {cycle + "Where", "X >", "character"}},
         {cycle + "Fixed axis=1, 0, 0",
          {cycle + "Fixed axis", "1, 0, 0", "Division axis = fixed"}}})
    expect_parts(complaint("", {"Proliferation/Law=cell cycle", text}), parts);
  expect_parts(complaint("",
                         {"Proliferation/Law=cell cycle",
                          cycle + "Division axis=fixed",
                          cycle + "Fixed axis=0, 0, 0"}),
               {cycle + "Fixed axis", "0, 0, 0", "zero"});
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


TEST(Scene, HasShorterVectorsAndFewerShapesInThePlane)
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
  expect_parts(complaint("", {"Dimension=2", "Tissue/Shape=cylinder"}),
               {"Tissue/Shape", "cylinder"});
  expect_parts(complaint("",
                         {"Dimension=2",
                          "Proliferation/Law=cell cycle",
                          "Proliferation/Cell cycle/Division axis=fixed"}),
               {"Proliferation/Cell cycle/Fixed axis", "zero"});
}


TEST(Scene, SaysWhereAKeyStands)
{
  expect_parts(complaint("subsection Growth\n set Stretch = 2\nend"),
               {"scene.prm:2: Growth/Stretch",
                "stands in subsection Growth/Isotropic"});
  expect_parts(complaint("", {"Growth/Stretch=2"}),
               {"-s: Growth/Stretch", "stands in subsection Growth/Isotropic"});
  expect_parts(complaint("subsection Cell cycle\nend"),
               {"scene.prm:1: subsection = 'Cell cycle'",
                "stands in subsection Proliferation"});
}


TEST(Scene, SuggestsChoices)
{
  expect_parts(complaint("subsection Tissue\n set Shape = spere\nend"),
               {"scene.prm:2: Tissue/Shape",
                "'spere'",
                "Did you mean 'sphere'?"});
  expect_parts(complaint("", {"Output/Formats=csv, vtk"}),
               {"Did you mean 'vtu'?"});
  expect_parts(complaint("", {"Grid/Extension=flase"}),
               {"Did you mean 'false'?"});
}
