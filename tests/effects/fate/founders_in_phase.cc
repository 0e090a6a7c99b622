// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  constexpr std::uint64_t seed = 3;
  constexpr double        T    = 2.; // day

  CellCycleParameters
  cycle_of_two_days()
  {
    CellCycleParameters parameters;
    parameters.duration  = "2";
    parameters.exit_rate = "0.5";
    parameters.where     = "X < 50";
    return parameters;
  }
} // namespace


TEST(FoundersInPhase, StandWhereTheirPhaseSays)
{
  const CellCycle<3>     cycle(cycle_of_two_days(), seed, 1e-9);
  const Point<3>         X;
  constexpr unsigned int n = 4000;
  using Range              = std::tuple<unsigned int, double, double>;
  for (const auto &[phase, begin, length] :
       {Range{1, 0., 0.25}, Range{2, 0.25, 0.25}, Range{4, 0.5, 0.5}})
    {
      double           sum = 0., squares = 0.;
      std::set<double> different;
      for (unsigned int id = 0; id < n; ++id)
        {
          const auto state = cycle.founder_in_phase(id, X, phase);
          EXPECT_EQ(cycle.phase_number(state, X, 0.), phase);
          EXPECT_FALSE(cycle.divides(state, X, 0.));
          EXPECT_NEAR(state.axis.norm(), 1., 1e-14);
          const double part = (-state.event_time / T - begin) / length;
          EXPECT_GE(part, 0.);
          EXPECT_LT(part, 1.);
          sum += part;
          squares += part * part;
          different.insert(part);
        }
      // mean 1/2 and mean square 1/3 of a uniform part, within 4 sigma
      EXPECT_NEAR(sum / n, 1. / 2., 4. * std::sqrt(1. / 12. / n));
      EXPECT_NEAR(squares / n, 1. / 3., 4. * std::sqrt(4. / 45. / n));
      EXPECT_GT(different.size(), n - 2);
    }
}

TEST(FoundersInPhase, WaitOrNever)
{
  const CellCycle<3> cycle(cycle_of_two_days(), seed, 1e-9);
  for (unsigned int id = 0; id < 50; ++id)
    {
      const Point<3> X;
      // a founder in G0 waits as one without a phase does
      const auto given = cycle.founder_in_phase(id, X, 0);
      const auto free  = cycle.founder(id, X);
      EXPECT_EQ(given.phase, CyclePhase::waiting);
      EXPECT_EQ(given.event_time, free.event_time);
      EXPECT_EQ(given.key, free.key);
      EXPECT_EQ(cycle.founder_in_phase(id, X, 9).phase, CyclePhase::never);
      // where nothing proliferates
      EXPECT_EQ(cycle.founder_in_phase(id, Point<3>(60., 0., 0.), 1).phase,
                CyclePhase::never);
    }
}

TEST(FoundersInPhase, BeginAtRestAndGrowOn)
{
  const CellDevelopment<3> development(
    {}, CellCycle<3>(cycle_of_two_days(), seed, 1e-9));
  const CellCycle<3> &cycle = *development.cycle();
  for (const unsigned int phase : {0, 1, 2, 4, 9})
    for (unsigned int id = 0; id < 20; ++id)
      {
        std::vector<double> row =
          development.columns().founder(Point<3>(), 1e3);
        const CellView<3, double> cell(make_array_view(row),
                                       development.columns());
        development.initialize(id, cell, 0.1, GivenState{phase, {}});
        const CycleState<3> state = development.clock(cell);
        const Point<3>      X;
        EXPECT_EQ(cycle.phase_number(state, X, 0.), phase);
        const Tensor<2, 3> unit = unit_symmetric_tensor<3>();
        EXPECT_LT((cycle.growth(state, X, 0.) - unit).norm(), 1e-14);
        if (phase == 0 || phase == 9)
          continue;
        // (6.2): from the volume that it has, 1 + a/T of a resting one, to
        // twice that of a resting one
        const double age = -state.event_time;
        EXPECT_NEAR(determinant(cycle.growth(state, X, T - age)),
                    2. / (1. + age / T),
                    1e-13);
      }
}
