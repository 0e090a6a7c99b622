// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/failed_step.h>

#include <gtest/gtest.h>

using namespace Morula;

namespace
{
  bool
  says(const FailedStep &step, const std::string &words)
  {
    return diagnosis(step).find(words) != std::string::npos;
  }

  /** A step that was halved six times, and began with less force each time. */
  FailedStep
  halved()
  {
    FailedStep step;
    step.first_force = 64.;
    step.last_force  = 1.;
    step.part        = 1. / 64.;
    step.energy      = 10.;
    step.smallest_J  = 0.8;
    return step;
  }
} // namespace


TEST(FailedStep, SaysNothingWithoutASign)
{
  EXPECT_EQ(diagnosis(halved()), "");
}


TEST(FailedStep, KnowsACrushedPoint)
{
  FailedStep step = halved();
  step.symmetric  = true;
  step.smallest_J = 1e-8;
  step.energy     = -1e6;
  EXPECT_TRUE(says(step, "A held point is crushed"));
  // A load may make the energy negative, another form has a least energy.
  step.loaded = true;
  EXPECT_FALSE(says(step, "crushed"));
  step.loaded    = false;
  step.symmetric = false;
  EXPECT_FALSE(says(step, "crushed"));
}


TEST(FailedStep, KnowsVolumesThatDoNotMatch)
{
  FailedStep step = halved();
  step.pointwise  = true;
  step.min_J      = 0.24;
  step.max_J      = 3.4;
  EXPECT_TRUE(says(step, "Set Material/Volumetric strain = pooled"));
  step.pointwise = false;
  EXPECT_FALSE(says(step, "pooled"));
  step.pointwise = true;
  step.min_J     = 0.9;
  step.max_J     = 1.1;
  EXPECT_FALSE(says(step, "pooled"));
}


TEST(FailedStep, KnowsAJump)
{
  FailedStep step = halved();
  step.last_force = 63.;
  EXPECT_TRUE(says(step, "jumps in time"));
  // Two attempts tell nothing.
  step.part = 0.5;
  EXPECT_FALSE(says(step, "jumps in time"));
}


TEST(FailedStep, KnowsAFormThatSeesNoCurvature)
{
  FailedStep step  = halved();
  step.unsymmetric = true;
  EXPECT_TRUE(says(step, "sees no curvature"));
  step.smallest_J = 0.1; // squeezed: the step is too long
  EXPECT_EQ(diagnosis(step), "");
}


TEST(FailedStep, KnowsAFold)
{
  FailedStep step = halved();
  step.curvature  = -1e-3;
  step.friction   = friction_against(step.curvature, 2., 10., 0.05);
  EXPECT_NEAR(step.friction, 1e-6, 1e-18);
  EXPECT_TRUE(says(step, "The tissue folds or buckles"));
  EXPECT_TRUE(says(step, "about 1e-06 kPa day/um^2"));
}
