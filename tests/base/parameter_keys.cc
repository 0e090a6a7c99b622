// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "base/room.h"

TEST(ParameterKeys, KnowUnitsAndChoices)
{
  const Scene                           scene;
  std::map<std::string, const AnyKey *> by_path;
  for (const AnyKey *key : scene.list())
    by_path.emplace(key->path(), key);
  using Words = std::vector<std::string>;
  EXPECT_EQ(by_path.at("Time/Step")->unit(), "day");
  EXPECT_EQ(by_path.at("Body force/Force density")->unit(), "kPa/um");
  EXPECT_EQ(by_path.at("Material/Poisson's ratio")->unit(), "");
  EXPECT_EQ(by_path.at("Boundary conditions/Nitsche form")->choices(),
            (Words{"symmetric", "unsymmetric", "bounded"}));
  EXPECT_EQ(by_path.at("Output/Formats")->choices(),
            (Words{"vtu", "csv", "none"}));
  EXPECT_TRUE(by_path.at("Time/Step")->choices().empty());
}


TEST(ParameterKeys, StandOnceEach)
{
  const Scene           scene;
  std::set<std::string> paths;
  for (const AnyKey *key : scene.list())
    EXPECT_TRUE(paths.insert(key->path()).second) << key->path();
}


TEST(ParameterKeys, KeepFormerNames)
{
  Key<double>      spacing("Grid/Spacing", 50., "h. Units: um.");
  Key<std::string> law("Grid/Law", "none", "A law.");
  spacing.formerly("Grid/Mesh size");

  const ParameterKeys keys({&spacing, &law});
  EXPECT_EQ(keys.current_name("Grid/Mesh size"), "Grid/Spacing");
  EXPECT_EQ(keys.current_name("Grid/Spacing"), "Grid/Spacing");
  EXPECT_EQ(keys.current_name("Grid/Other"), "Grid/Other");

  keys.apply({false, "Grid/Mesh size", "20", ""});
  EXPECT_EQ(spacing, 20.);
  expect_parts(complaint_of(
                 [&] { keys.apply({false, "Grid/Mesh size", "wide", ""}); }),
               {"Grid/Spacing", "'wide'", "a number"});

  std::ostringstream printed;
  keys.print(printed);
  expect_parts(printed.str(),
               {"# Formerly: Grid/Mesh size\n  set Spacing = 50"});
}
