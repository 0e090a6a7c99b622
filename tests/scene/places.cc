// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "scene/room.h"

Scene
read(const std::string &text, const std::vector<std::string> &overrides = {})
{
  return Scene::read(TemporaryFile(".prm", text).path, overrides);
}

/** What reading says about a scene. */
std::string
complaint(const std::string &text)
{
  return complaint_of([&] { read(text); });
}



TEST(ScenePlaces, AreThoseOfSubsectionsWithoutEnd)
{
  const std::string cycle = "subsection Proliferation\n"
                            "  set Law = cell cycle\n"
                            "  subsection Cell cycle\n"
                            "    set Duration = 2\n"
                            "  end\n";
  expect_parts(complaint(cycle + "subsection Grid\nend\nend\n"),
               {".prm:6: unknown section 'Proliferation/Grid'",
                "Did you mean 'Grid'? Is an 'end' missing above?"});
  expect_parts(complaint(cycle), {".prm:1: subsection", "Proliferation"});
  expect_parts(complaint("subsection Growth\n"
                         "  subsection Isotropic\n"
                         "  set Law = isotropic\n"),
               {".prm:1: subsection 'Growth'", "ends with line 3"});
}


TEST(ScenePlaces, AreThoseOfValuesRefusedLater)
{
  const Scene scene =
    read("\nsubsection Grid\n  set Spacing = -5\nend\n", {"Time/Step=0.2"});
  expect_parts(scene.located("Grid/Spacing = '-5': allowed is"),
               {".prm:3: Grid/Spacing = '-5'"});
  expect_parts(scene.located("Grid/Spacing (some file, line 3) = '-5'"),
               {".prm:3: Grid/Spacing (some"});
  EXPECT_EQ(scene.located("Time/Step = '0.2'"), "-s: Time/Step = '0.2'");
  // A key that the scene does not set is said to have none.
  EXPECT_EQ(scene.located("Time/End time = '1'"),
            "Time/End time = '1' The scene does not set this key.");
  EXPECT_EQ(scene.located("no message"), "no message");
}


TEST(ScenePlaces, OfKeysThatAreSetTwice)
{
  const std::string grid = "subsection Grid\n  set Spacing = 40\nend\n";
  EXPECT_TRUE(
    read(grid, {"Grid/Spacing=30", "Grid/Spacing=20"}).renamed.empty());

  const Scene twice = read(grid + "subsection Grid\n  set Spacing = 30\nend\n");
  ASSERT_EQ(twice.renamed.size(), 1u);
  expect_parts(twice.renamed[0],
               {".prm:5: the key 'Grid/Spacing' is set to '30'",
                ".prm:2: it was set to '40'"});

  // Who includes a file may set its keys anew, but not before it.
  const TemporaryFile base(".prm", grid);
  EXPECT_TRUE(read("include " + base.path + "\n" + grid).renamed.empty());
  EXPECT_EQ(read(grid + "include " + base.path + "\n").renamed.size(), 1u);
}
