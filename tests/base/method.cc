// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/scene/scene.h>

#include <gtest/gtest.h>

#include "common/temporary_file.h"


using namespace Morula;

namespace
{
  Scene
  read(const std::string &text, const std::vector<std::string> &overrides = {})
  {
    const TemporaryFile file(".prm", text);
    Scene               scene = Scene::read(file.path, overrides);
    scene.output_directory    = "output"; // not the file's name
    return scene;
  }

  const std::string consistent = "set Method = consistent\n";
  const std::string penalty =
    "subsection Boundary conditions\n set Nitsche penalty = 77\nend\n";
} // namespace


TEST(Method, PaperLeavesTheDefaults)
{
  const Scene silent = read("");
  EXPECT_EQ(silent.method, "paper");
  EXPECT_EQ(silent.nitsche.form, "symmetric");
  EXPECT_EQ(silent.nitsche.penalty, 1000.);
  EXPECT_EQ(read("set Method = paper").parameters(), silent.parameters());
}


TEST(Method, ConsistentSetsWhatTheSceneDoesNot)
{
  const Scene scene = read(consistent);
  EXPECT_EQ(scene.nitsche.form, "bounded");
  EXPECT_EQ(scene.nitsche.penalty, 20.);
  // as a default does: the user has not written it
  EXPECT_EQ(scene.as_written.size(), 1u);
  EXPECT_EQ(read("", {"Method=consistent"}).parameters(), scene.parameters());
}


TEST(Method, GivesWayToTheSceneWhereverThatSetsAKey)
{
  for (const Scene &scene :
       {read(consistent + penalty),
        read(penalty + consistent),
        read(penalty, {"Method=consistent"}),
        read(consistent, {"Boundary conditions/Nitsche penalty=77"})})
    {
      EXPECT_EQ(scene.nitsche.form, "bounded");
      EXPECT_EQ(scene.nitsche.penalty, 77.);
    }
}


TEST(Method, IsThereAgainInTheParametersOfARun)
{
  const Scene scene = read(consistent + penalty);
  const Scene again = read(scene.parameters());
  EXPECT_EQ(again.parameters(), scene.parameters());
  EXPECT_EQ(again.method, "consistent");
  EXPECT_EQ(again.nitsche.form, "bounded");
  EXPECT_EQ(again.nitsche.penalty, 77.);

  // what a program has changed since the scene was read
  Scene changed        = read(consistent);
  changed.nitsche.form = "symmetric";
  EXPECT_EQ(read(changed.parameters()).nitsche.form, "symmetric");
}


TEST(Method, RefusesWhatItDoesNotKnow)
{
  try
    {
      read("\nset Method = consistant");
      ADD_FAILURE();
    }
  catch (const InputError &error)
    {
      const std::string text = error.what();
      for (const char *part :
           {".prm:2", "Method", "Did you mean 'consistent'?", "paper"})
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
}
