// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/fate/cell_cycle.h>
#include <morula/effects/fate/random.h>

#include <gtest/gtest.h>

#include <cmath>

#include "effects/lone_cell.h"

using namespace Morula;

namespace
{
  constexpr std::uint64_t seed  = 3;
  constexpr double        slack = 5e-11;

  /** A cell with a wait that ends at @p time. */
  template <int dim>
  CycleState<dim>
  cell_that_waits_until(const double time)
  {
    CycleState<dim> state;
    state.phase      = CyclePhase::waiting;
    state.event_time = time;
    state.key        = 12345678901234567890u;
    state.growth_pre = unit_symmetric_tensor<dim>();
    return state;
  }
} // namespace


TEST(ExactOnsets, CheckpointIsPassedAtTheExactTime)
{
  CellCycleParameters parameters;
  parameters.size_checkpoint = "0.9";
  const CellCycle<3> cycle(parameters, seed, slack);
  const Point<3>     X;
  const auto         begins = [&](const double       wait,
                          const ElasticSize &size) -> double {
    const auto state =
      cycle.advance(cell_that_waits_until<3>(wait), X, 0.3, 0.4, size);
    return state.phase == CyclePhase::growing ? state.event_time : -1.;
  };
  // J_e goes on as in the last step, from 0.2 to 0.3.
  EXPECT_EQ(begins(0.35, {0.91, -0.1, 0.2}), 0.35);
  EXPECT_EQ(begins(0.35, {0.91, -0.3, 0.2}), -1.);
  EXPECT_EQ(begins(0.35, {0.89, 0.3, 0.2}), 0.35);
  EXPECT_EQ(begins(0.35, {0.89, 0.1, 0.2}), -1.);
  // One that was held began where J_e crossed the threshold, but not before its
  // wait ended, nor before the last step.
  EXPECT_NEAR(begins(0.1, {0.92, 0.4, 0.2}), 0.25, 1e-14);
  EXPECT_NEAR(begins(0.28, {0.92, 0.4, 0.2}), 0.28, 1e-14);
  EXPECT_NEAR(begins(0.1, {0.92, 0.1, 0.2}), 0.2, 1e-14);
  EXPECT_NEAR(begins(0.1, {0.92, -0.1, 0.2}), 0.2, 1e-14);
  EXPECT_EQ(begins(0.1, {0.9, 0.4, 0.2}), -1.);
}


TEST(ExactOnsets, WaitSeesTheMiddleOfTheStep)
{
  CellCycleParameters parameters;
  parameters.exit_rate = "2*t";
  const CellCycle<2> cycle(parameters, seed, slack);
  EXPECT_FALSE(cycle.keeps_exit_rate());
  LoneCell<2> scene;
  scene.place(Point<2>());
  const auto    present = scene.present();
  CycleState<2> state   = cycle.founder(3, CellAt<2>(present, 0.));
  const double  until   = Random::exponential(seed, state.key, 1.);
  // t² reaches it.
  const double step = 0.01;
  for (unsigned int n = 0; n < 1000 && state.phase == CyclePhase::waiting; ++n)
    state = cycle.advance(
      state, CellAt<2>(present, n * step), n * step, (n + 1) * step, 1.);
  EXPECT_NEAR(state.event_time, std::sqrt(until), 1e-4);
}
