// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "base/room.h"

Scene
read(const std::string &text, const std::vector<std::string> &overrides = {})
{
  const TemporaryFile file(".prm", text);
  Scene               scene = Scene::read(file.path, overrides);
  scene.output_directory    = "output"; // not the file's name
  return scene;
}

const std::string paper = "set Method = paper\n";
const std::string penalty =
  "subsection Boundary conditions\n set Nitsche penalty = 77\nend\n";


TEST(Method, ConsistentLeavesTheDefaults)
{
  const Scene silent = read("");
  EXPECT_EQ(silent.method, "consistent");
  EXPECT_EQ(silent.nitsche.form, "bounded");
  EXPECT_EQ(silent.nitsche.penalty, 20.);
  EXPECT_EQ(read("set Method = consistent").parameters(), silent.parameters());
}


TEST(Method, PaperSetsWhatTheSceneDoesNot)
{
  const Scene scene = read(paper);
  EXPECT_EQ(scene.nitsche.form, "symmetric");
  EXPECT_EQ(scene.nitsche.penalty, 1000.);
  // as a default does: the user has not written it
  EXPECT_EQ(scene.as_written.size(), 1u);
  EXPECT_EQ(read("", {"Method=paper"}).parameters(), scene.parameters());
}


TEST(Method, GivesWayToTheSceneWhereverThatSetsAKey)
{
  for (const Scene &scene :
       {read(paper + penalty),
        read(penalty + paper),
        read(penalty, {"Method=paper"}),
        read(paper, {"Boundary conditions/Nitsche penalty=77"})})
    {
      EXPECT_EQ(scene.nitsche.form, "symmetric");
      EXPECT_EQ(scene.nitsche.penalty, 77.);
    }
}


TEST(Method, IsThereAgainInTheParametersOfARun)
{
  const Scene scene = read(paper + penalty);
  const Scene again = read(scene.parameters());
  EXPECT_EQ(again.parameters(), scene.parameters());
  EXPECT_EQ(again.method, "paper");
  EXPECT_EQ(again.nitsche.form, "symmetric");
  EXPECT_EQ(again.nitsche.penalty, 77.);

  // what a program has changed since the scene was read
  Scene changed        = read(paper);
  changed.nitsche.form = "bounded";
  EXPECT_EQ(read(changed.parameters()).nitsche.form, "bounded");
}
