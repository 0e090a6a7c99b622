// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "simulation/room.h"

/** The parameters of a scene without one of its keys. */
std::string
without(const std::string &key, const Scene &scene)
{
  return std::regex_replace(scene.parameters(),
                            std::regex("set " + key + " *=[^\n]*\n"),
                            "");
}


TEST(SnapshotCheck, AcceptsTheSameSceneAndAnotherEndButNoOtherTissue)
{
  const Scene scene;
  check_resumable(scene, scene.parameters());
  Scene other;
  other.time.end_time = 7.;
  check_resumable(other, scene.parameters());
  other.tissue.radius = 100.;
  EXPECT_THROW(check_resumable(other, scene.parameters()), InputError);
}


TEST(SnapshotCheck, TakesAKeyThatTheSnapshotLacksForThePapers)
{
  Scene             scene;
  const std::string older = without("Surface cells", scene);
  ASSERT_NE(older, scene.parameters());
  EXPECT_THROW(check_resumable(scene, older), InputError);
  scene.tissue.surface_cells = "whole";
  check_resumable(scene, older);
  scene.tissue.surface_cells = "trimmed";
  EXPECT_THROW(check_resumable(scene, older), InputError);
}


TEST(SnapshotCheck, ComparesWhatMethodStandsFor)
{
  // a snapshot of before that key holds the values that the paper's method has
  Scene             scene;
  const std::string older = without("Method", scene);
  ASSERT_NE(older, scene.parameters());
  check_resumable(scene, older);

  // the word alone does not matter ...
  scene.method = "consistent";
  check_resumable(scene, older);
  // ... what it has set does
  scene.nitsche.form    = "unsymmetric";
  scene.nitsche.penalty = 20.;
  EXPECT_THROW(check_resumable(scene, older), InputError);
  Scene words  = scene;
  words.method = "paper";
  check_resumable(words, scene.parameters());
}


TEST(SnapshotCheck, RefusesKeysOfALaterProgram)
{
  const Scene scene;
  expect_parts(complaint_of([&] {
                 check_resumable(scene,
                                 "set Flavour = sweet\n" + scene.parameters());
               }),
               {"Flavour"});
}
