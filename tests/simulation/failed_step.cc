// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "simulation/room.h"

/** What is said of a step that was halved six times, and began with less force
 *  each time, where something else about it is as @p change says. */
std::string
said(const std::function<void(FailedStep &)> &change)
{
  FailedStep step;
  step.first_force = 64.;
  step.last_force  = 1.;
  step.part        = 1. / 64.;
  step.energy      = 10.;
  step.smallest_J  = 0.8;
  change(step);
  return diagnosis(step);
}


TEST(FailedStep, SaysWhatTheSignsMean)
{
  EXPECT_EQ(said([](FailedStep &) {}), "");
  // A load may make the energy negative, another form has a least energy.
  const auto crushed = [](const bool symmetric, const bool loaded) {
    return said([=](FailedStep &step) {
      step.symmetric  = symmetric;
      step.loaded     = loaded;
      step.smallest_J = 1e-8;
      step.energy     = -1e6;
    });
  };
  expect_parts(crushed(true, false), {"A fixed point is crushed"});
  EXPECT_EQ(crushed(true, true).find("crushed"), std::string::npos);
  EXPECT_EQ(crushed(false, false).find("crushed"), std::string::npos);

  const auto jump = [](const double part) {
    return said([=](FailedStep &step) {
      step.last_force = 63.;
      step.part       = part;
    });
  };
  expect_parts(jump(1. / 64.), {"jumps in time"});
  EXPECT_EQ(jump(0.5).find("jumps"), std::string::npos); // two attempts

  const auto curved = [](const double smallest_J) {
    return said([=](FailedStep &step) {
      step.curvature  = -1e-3;
      step.smallest_J = smallest_J;
    });
  };
  expect_parts(curved(0.8), {"folds or buckles"});
  EXPECT_EQ(curved(0.1), ""); // squeezed: the step is too long
}


TEST(FailedStep, KnowsAFold)
{
  const double friction = friction_against(-1e-3, 2., 10., 0.05);
  EXPECT_NEAR(friction, 1e-6, 1e-18);
  expect_parts(said([=](FailedStep &step) {
                 step.curvature = -1e-3;
                 step.friction  = friction;
               }),
               {"The tissue folds or buckles", "about 1e-06 kPa day/um^2"});
}
