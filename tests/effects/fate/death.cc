// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  const std::vector<std::string> dying = {"Dimension=2",
                                          "Material/Energy per=grown volume",
                                          "Death/Shrinking time=0.25",
                                          "Death/Final volume=0.2"};
} // namespace


TEST(Death, CellsShrinkLinearlyInVolume)
{
  Alone alone(with(dying, {"Death/When=t >= 0.1"}));
  EXPECT_TRUE(alone.step(0., 0.1).empty());
  EXPECT_NEAR(determinant(alone.cell().growth()), 1., 1e-14);
  const auto events = alone.step(0.1, 0.2);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].time, 0.1);
  EXPECT_TRUE(events[0].kind == CellEvent::death);
  EXPECT_STREQ(events[0].cause, "when");
  // 1 - 0.8 (t - 0.1)/0.25
  EXPECT_NEAR(determinant(alone.cell().growth()), 0.68, 1e-14);
  EXPECT_NEAR(alone.cell().growth()[0][0], std::sqrt(0.68), 1e-14);
  EXPECT_EQ(alone.cell().growth()[0][1], 0.);
  EXPECT_TRUE(alone.step(0.2, 0.3).empty());
  EXPECT_NEAR(determinant(alone.cell().growth()), 0.36, 1e-14);
  EXPECT_TRUE(remove_dead_cells(alone.tissue, alone.development, 0.3).empty());
  alone.step(0.3, 0.4);
  EXPECT_NEAR(determinant(alone.cell().growth()), 0.2, 1e-14);
  const auto removals = remove_dead_cells(alone.tissue, alone.development, 0.4);
  ASSERT_EQ(removals.size(), 1u);
  EXPECT_NEAR(removals[0].time, 0.35, 1e-14);
  EXPECT_EQ(alone.tissue.cells().size(), 0u);
}


TEST(Death, DebrisStays)
{
  Alone alone(
    with(dying, {"Death/When=t >= 0.1", "Death/Keep debris=noise < 2"}));
  for (const double t : {0., 0.1, 0.2, 0.3, 0.4, 0.5})
    alone.step(t, t + 0.1);
  EXPECT_NEAR(determinant(alone.cell().growth()), 0.2, 1e-14);
  EXPECT_TRUE(remove_dead_cells(alone.tissue, alone.development, 9.).empty());
}


// What is left of a shrunken cell is taken over by those in its grid cell, so
// that it leaves no hole; a cut is meant to leave one.
TEST(Death, HandsItsRestOn)
{
  for (const bool is_cut : {false, true})
    {
      auto settings = with(dying, {"Death/When=X > 5"});
      if (is_cut)
        settings.push_back("Death/Shrinking time=0");
      // The last one has a grid cell of its own.
      Alone some(settings, {{3., 4.}, {8., 4.}, {4., 9.}, {200., 4.}});
      some.step(0., 0.3);
      const Cells<2>                         &cells = some.tissue.cells();
      std::map<types::particle_index, double> volumes;
      for (unsigned int p = 0; p < cells.size(); ++p)
        volumes[cells.id(p)] = cells.volume(p);
      EXPECT_EQ(remove_dead_cells(some.tissue, some.development, 0.3).size(),
                2u);
      ASSERT_EQ(cells.size(), 2u);
      const double rest = is_cut ? 0. : volumes[1];
      for (const unsigned int p : {0, 1})
        {
          const double V = volumes[cells.id(p)];
          EXPECT_NEAR(cells.volume(p),
                      V * (1. + rest / (volumes[0] + volumes[2])),
                      1e-12 * V);
        }
    }
}


// What is gone at once does not shrink before: nothing pulls at its neighbours.
TEST(Death, CutsDoNotPull)
{
  Alone alone({"Dimension=2", "Death/When=1", "Death/Shrinking time=0"});
  alone.step(0., 0.1);
  EXPECT_EQ(determinant(alone.cell().growth()), 1.);
  EXPECT_EQ(remove_dead_cells(alone.tissue, alone.development, 0.1).size(), 1u);
}


// It has grown until its death, in the middle of a step, and has left the cycle
// undivided.
TEST(Death, EndsGrowthAndCycle)
{
  const auto   settings = with(dying,
                               {"Growth/Law=rate",
                                "Growth/Rate/Rate=0.4",
                                "Proliferation/Law=cell cycle",
                                "Proliferation/Cell cycle/Start=together",
                                "Proliferation/Cell cycle/Duration=4",
                                "Death/Rate=3"});
  Alone        alone(settings);
  double       death = -1.;
  const double step  = 0.5;
  for (double t = 0.; death < 0.; t += step)
    {
      const auto events = alone.step(t, t + step);
      if (events.empty())
        continue;
      death = events[0].time;
      ASSERT_GT(death, t);
      ASSERT_LT(death, std::min(t + step, 2.));
      EXPECT_STREQ(events[0].cause, "rate");
      const double part = std::min(1., (t + step - death) / 0.25);
      EXPECT_NEAR(determinant(alone.cell().growth()),
                  std::exp(0.4 * death) * (1. + death / 4.) * (1. - 0.8 * part),
                  1e-12);
    }
  EXPECT_TRUE(cells_due(alone.tissue, alone.development, 100.).empty());
  // The law grows no more, and nobody dies twice.
  EXPECT_TRUE(alone.step(4., 4.5).empty());
  EXPECT_NEAR(determinant(alone.cell().growth()),
              0.2 * std::exp(0.4 * death) * (1. + death / 4.),
              1e-12);
}


// Of death, division and transitions the earliest comes first, in steps of any
// length.
TEST(Death, EventsDoNotDependOnTheStep)
{
  const Scene scene =
    scene_of(with(dying,
                  {"Cell types/Names=stem, leaf",
                   "Proliferation/Law=cell cycle",
                   "Proliferation/Cell cycle/Duration=0.4",
                   "Proliferation/Cell cycle/G0 exit rate=1.5",
                   "Cell types/stem/Transitions/To leaf=0.5",
                   "Cell types/leaf/Transitions/To stem=2",
                   "Death/Rate=0.4",
                   "Cell types/leaf/Death/Rate=1.5",
                   "Cell types/leaf/Death/Shrinking time=0.05"}));
  const Lives                 whole = lead(scene, 30, 3.2, 0.2);
  const Lives                 half  = lead(scene, 30, 3.2, 0.1);
  std::array<unsigned int, 3> n     = {{0, 0, 0}};
  for (const CellEvent &event : whole.events)
    ++n[event.kind.order];
  EXPECT_GT(n[0], 30u);
  EXPECT_GT(n[1], 30u);
  EXPECT_GT(n[2], 30u);
  EXPECT_GT(whole.births.size(), 30u);
  expect_same(whole, half);
}
