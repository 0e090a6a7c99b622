// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  constexpr std::uint64_t seed  = 3;
  constexpr double        slack = 5e-11; // 1e-9 x a step of 0.05 day

  /** A cell with a wait that ends at @p time. */
  template <int dim>
  CycleState<dim>
  waiting_until(const double time)
  {
    CycleState<dim> state;
    state.phase      = CyclePhase::waiting;
    state.event_time = time;
    state.key        = 12345678901234567890u;
    state.growth_pre = unit_symmetric_tensor<dim>();
    return state;
  }

  template <int dim>
  CycleState<dim>
  in_phase(const CyclePhase phase, const double onset)
  {
    CycleState<dim> state = waiting_until<dim>(onset);
    state.phase           = phase;
    state.axis[dim - 1]   = 1.;
    return state;
  }

  template <int dim>
  void
  expect_equal(const CycleState<dim> &a, const CycleState<dim> &b)
  {
    EXPECT_EQ(a.phase, b.phase);
    EXPECT_EQ(a.event_time, b.event_time);
    EXPECT_EQ(a.key, b.key);
    EXPECT_EQ(a.axis, b.axis);
    EXPECT_EQ(a.growth_pre, b.growth_pre);
  }
} // namespace


TEST(CellCycle, FoundersWait)
{
  CellCycleParameters parameters;
  parameters.exit_rate = "2 + X";
  parameters.where     = "Y < 1";
  const CellCycle<2> cycle(parameters, seed, slack);

  const Point<2> X(3., 0.5);
  const auto     state = cycle.founder(17, X);
  const auto     key   = Random::founder_key(seed, 17);
  EXPECT_EQ(state.phase, CyclePhase::waiting);
  EXPECT_EQ(state.key, key);
  EXPECT_EQ(state.event_time, Random::exponential(seed, key, 5.));
  EXPECT_EQ(cycle.phase_number(state, X, 0.), 0u);
  EXPECT_TRUE(cycle.growth(state, X, 0.) == unit_tensor<2>());
}


TEST(CellCycle, ExcludedFoundersNeverProliferate)
{
  for (const std::string start : {"waiting", "together"})
    {
      CellCycleParameters parameters;
      parameters.start = start;
      parameters.where = "Y";
      const CellCycle<2> cycle(parameters, seed, slack);

      const Point<2> X(3., 0.);
      const auto     state = cycle.founder(17, X);
      EXPECT_EQ(state.phase, CyclePhase::never);
      expect_equal(cycle.advance(state, X, 0., 1e6, 1.), state);
      EXPECT_FALSE(cycle.divides(state, X, 1e6));
      EXPECT_FALSE(cycle.is_held(state, X, 1e6, 0.));
      EXPECT_EQ(cycle.phase_number(state, X, 1e6), 9u);
      EXPECT_TRUE(cycle.growth(state, X, 1e6) == unit_tensor<2>());
    }
}


TEST(CellCycle, TogetherStartsAtOnce)
{
  CellCycleParameters parameters;
  parameters.start = "together";
  const CellCycle<3> cycle(parameters, seed, slack);

  const auto state = cycle.founder(4, Point<3>());
  EXPECT_EQ(state.phase, CyclePhase::growing);
  EXPECT_EQ(state.event_time, 0.);
  EXPECT_EQ(state.axis, Random::direction<3>(seed, state.key));
  EXPECT_EQ(cycle.division_time(state, Point<3>()), 0.5);
  EXPECT_EQ(cycle.phase_number(state, Point<3>(), 0.), 1u);

  // Cells at rest do not pass a checkpoint at 1.
  parameters.size_checkpoint = "1";
  const CellCycle<3> strict(parameters, seed, slack);
  const auto         held = strict.founder(4, Point<3>());
  EXPECT_TRUE(strict.is_held(held, Point<3>(), 0., 1.));
  EXPECT_EQ(strict.advance(held, Point<3>(), 0.2, 0.3, 1.01).event_time, 0.2);
}


TEST(CellCycle, WaitEndsAtItsExactTime)
{
  const CellCycle<3> cycle(CellCycleParameters(), seed, slack);
  const Point<3>     X;

  const auto waiting = waiting_until<3>(0.33);
  expect_equal(cycle.advance(waiting, X, 0.2, 0.3, 1.), waiting);

  const auto growing = cycle.advance(waiting, X, 0.3, 0.4, 1.);
  EXPECT_EQ(growing.phase, CyclePhase::growing);
  EXPECT_EQ(growing.event_time, 0.33);
  EXPECT_EQ(growing.axis, Random::direction<3>(seed, growing.key));

  // Within the slack, a wait ends with the step.
  EXPECT_EQ(cycle.advance(waiting, X, 0.3, 0.33 - 0.5 * slack, 1.).phase,
            CyclePhase::growing);
  EXPECT_EQ(cycle.advance(waiting, X, 0.3, 0.33 - 2. * slack, 1.).phase,
            CyclePhase::waiting);
}


TEST(CellCycle, CheckpointHolds)
{
  CellCycleParameters parameters;
  parameters.size_checkpoint = "0.9 + 0 * X";
  const CellCycle<3> cycle(parameters, seed, slack);
  const Point<3>     X;

  // Large enough at the step's start: exact onset.
  const auto waiting = waiting_until<3>(0.33);
  EXPECT_EQ(cycle.advance(waiting, X, 0.3, 0.4, 0.901).event_time, 0.33);

  // At the threshold: held, however long.
  EXPECT_FALSE(cycle.is_held(waiting, X, 0.3, 0.9));
  auto held = cycle.advance(waiting, X, 0.3, 0.4, 0.9);
  expect_equal(held, waiting);
  EXPECT_TRUE(cycle.is_held(held, X, 0.4, 0.9));
  EXPECT_FALSE(cycle.is_held(held, X, 0.4, 0.901));
  EXPECT_EQ(cycle.phase_number(held, X, 0.4), 0u);
  held = cycle.advance(held, X, 0.4, 0.5, 0.5);
  expect_equal(held, waiting);

  // Released at a step's start.
  const auto released = cycle.advance(held, X, 0.5, 0.6, 0.901);
  EXPECT_EQ(released.phase, CyclePhase::growing);
  EXPECT_EQ(released.event_time, 0.5);
}


TEST(CellCycle, PhasesByAge)
{
  CellCycleParameters parameters;
  parameters.duration = "2";
  const CellCycle<3> cycle(parameters, seed, slack);
  const Point<3>     X;
  const auto         number = [&](const CyclePhase phase, const double age) {
    return cycle.phase_number(in_phase<3>(phase, 0.3), X, 0.3 + age);
  };

  EXPECT_EQ(number(CyclePhase::growing, 0.), 1u);
  EXPECT_EQ(number(CyclePhase::growing, 0.4999), 1u);
  EXPECT_EQ(number(CyclePhase::growing, 0.5), 2u);
  EXPECT_EQ(number(CyclePhase::growing, 0.9999), 2u);
  EXPECT_EQ(number(CyclePhase::growing, 1.), 3u);
  EXPECT_EQ(number(CyclePhase::divided, 1.), 3u);
  EXPECT_EQ(number(CyclePhase::divided, 1.0001), 4u);
  EXPECT_EQ(number(CyclePhase::divided, 2.), 4u);
}


// Steps that hit the division and the end of the cycle up to rounding.
TEST(CellCycle, EventsAtStepEnds)
{
  for (unsigned int n = 2; n <= 400; n += 2)
    {
      CellCycleParameters parameters;
      parameters.start        = "together";
      parameters.duration     = "0.7";
      const double       step = 0.7 / n;
      const CellCycle<3> cycle(parameters, seed, 1e-9 * step);
      const Point<3>     X;
      cycle.check({X}, step);

      CycleState<3> state = cycle.founder(0, X);
      for (unsigned int k = 1; k <= n + 1; ++k)
        {
          const double t1 = k * step;
          state           = cycle.advance(state, X, (k - 1) * step, t1, 1.);
          EXPECT_EQ(cycle.divides(state, X, t1), k == n / 2) << n;
          if (k == n / 2)
            state = cycle.daughters(state).first;
          if (k < n)
            {
              EXPECT_EQ(state.phase == CyclePhase::divided, k >= n / 2) << n;
            }
          if (k == n)
            {
              EXPECT_EQ(cycle.phase_number(state, X, t1), 4u) << n;
            }
        }
      EXPECT_NE(state.phase, CyclePhase::divided) << n;
    }
}


TEST(CellCycle, GrowthDoublesOverACycle)
{
  CellCycleParameters parameters;
  parameters.duration = "0.8";
  const CellCycle<3> cycle(parameters, seed, slack);
  const Point<3>     X;

  Tensor<2, 3> previous;
  previous[0][0] = 1.5;
  previous[0][1] = 0.2;
  previous[1][1] = 0.9;
  previous[2][0] = -0.3;
  previous[2][2] = 1.1;

  CycleState<3> state = waiting_until<3>(0.15);
  state.growth_pre    = previous;
  EXPECT_EQ(cycle.growth(state, X, 0.1), previous);

  state             = cycle.advance(state, X, 0.1, 0.2, 1.);
  const auto n      = state.axis;
  const auto theory = [&](const double t) {
    return (unit_tensor<3>() + (t - 0.15) / 0.8 * outer_product(n, n)) *
           previous;
  };
  EXPECT_NEAR((cycle.growth(state, X, 0.2) - theory(0.2)).norm(), 0., 1e-15);

  // The division at 0.55 falls into the step.
  state = cycle.advance(state, X, 0.2, 0.6, 1.);
  EXPECT_EQ(state.phase, CyclePhase::growing);
  ASSERT_TRUE(cycle.divides(state, X, 0.6));
  EXPECT_DOUBLE_EQ(cycle.division_time(state, X), 0.55);
  const auto daughters = cycle.daughters(state);
  for (auto daughter : {daughters.first, daughters.second})
    {
      EXPECT_EQ(daughter.phase, CyclePhase::divided);
      EXPECT_EQ(daughter.event_time, 0.15);
      EXPECT_EQ(daughter.axis, n);
      EXPECT_EQ(cycle.growth(daughter, X, 0.6), cycle.growth(state, X, 0.6));

      daughter = cycle.advance(daughter, X, 0.6, 0.9, 1.);
      EXPECT_NEAR((cycle.growth(daughter, X, 0.9) - theory(0.9)).norm(),
                  0.,
                  1e-15);

      daughter = cycle.advance(daughter, X, 0.9, 1., 1.);
      EXPECT_NEAR((daughter.growth_pre - theory(0.95)).norm(), 0., 1e-15);
      EXPECT_NEAR(determinant(daughter.growth_pre),
                  2. * determinant(previous),
                  1e-14);
      EXPECT_DOUBLE_EQ(daughter.event_time,
                       0.95 + Random::exponential(seed, daughter.key, 1.));
    }
  EXPECT_EQ(daughters.first.key, Random::daughter_key(seed, state.key, 0));
  EXPECT_EQ(daughters.second.key, Random::daughter_key(seed, state.key, 1));
}


TEST(CellCycle, SeveralPhaseChangesInOneStep)
{
  CellCycleParameters parameters;
  parameters.duration        = "4";
  parameters.exit_rate       = "100";
  parameters.size_checkpoint = "0.9";
  const CellCycle<2> cycle(parameters, seed, slack);
  const Point<2>     X;

  // G1 -> G0 -> S.
  const auto   cell = in_phase<2>(CyclePhase::divided, 1.);
  const double wait = Random::exponential(seed, cell.key, 100.);
  ASSERT_LT(wait, 0.5);
  auto state = cycle.advance(cell, X, 4.9, 5.5, 1.);
  EXPECT_EQ(state.phase, CyclePhase::growing);
  EXPECT_DOUBLE_EQ(state.event_time, 5. + wait);
  EXPECT_NEAR(determinant(state.growth_pre), 2., 1e-15);
  EXPECT_NEAR(determinant(cycle.growth(state, X, 5.5)),
              2. * (1. + (0.5 - wait) / 4.),
              1e-14);

  // The same, but held at the checkpoint.
  state = cycle.advance(cell, X, 4.9, 5.5, 0.9);
  EXPECT_TRUE(cycle.is_held(state, X, 5.5, 0.9));
  EXPECT_EQ(cycle.growth(state, X, 5.5), state.growth_pre);
  EXPECT_NEAR(determinant(state.growth_pre), 2., 1e-15);
}


TEST(DivisionAxes, FollowRotationOnRequest)
{
  CellColumns<3>            columns;
  StateColumns<3>           state;
  std::vector<double>       row = columns.founder(Point<3>(), 1.);
  const CellView<3, double> cell(make_array_view(row), columns);
  Tensor<2, 3>              F;
  F[0][2] = 2.;
  F[1][0] = 0.5;
  F[2][1] = 1.;
  cell.set(columns.deformation, F);
  const Tensor<1, 3> z({0., 0., 1.}), x({1., 0., 0.});
  DivisionParameters keys;
  EXPECT_EQ(DivisionAxes<3>(keys, state, seed).placement(cell, z, 0), z);
  keys.axis_follows_rotation = true;
  EXPECT_EQ(DivisionAxes<3>(keys, state, seed).placement(cell, z, 0), x);
}


TEST(CellCycle, TheShortestCycleAmongProliferatingFoundersCounts)
{
  const std::vector<Point<3>> founders = {Point<3>(0., 0., 0.),
                                          Point<3>(1., 0., 0.),
                                          Point<3>(2., 0., 0.)};
  CellCycleParameters         parameters;
  const auto                  check = [&](const double step) {
    CellCycle<3>(parameters, seed, 1e-9 * step).check(founders, step);
  };

  EXPECT_NO_THROW(check(0.5));
  EXPECT_THROW(check(0.50001), InputError);

  parameters.duration = "1 - 0.4 * X";
  parameters.where    = "X < 1.5";
  EXPECT_NO_THROW(check(0.3));
  EXPECT_THROW(check(0.31), InputError);
  parameters.where = "X < 0.5";
  EXPECT_NO_THROW(check(0.5));
  parameters.where = "-1";
  EXPECT_NO_THROW(check(100.));
}


TEST(CellCycle, CheckpointIsPassedAtTheExactTime)
{
  CellCycleParameters parameters;
  parameters.size_checkpoint = "0.9";
  const CellCycle<3> cycle(parameters, seed, slack);
  const Point<3>     X;
  const auto         begins = [&](const double       wait,
                          const ElasticSize &size) -> double {
    const auto state = cycle.advance(waiting_until<3>(wait), X, 0.3, 0.4, size);
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


TEST(CellCycle, WaitSeesTheMiddleOfTheStep)
{
  CellCycleParameters parameters;
  parameters.exit_rate = "2*t";
  const CellCycle<2> cycle(parameters, seed, slack);
  EXPECT_FALSE(cycle.rate_of_exit().follows_state());
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
