// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

// Hazards whose rates follow the state, doc/theory.md (5.9).
namespace
{
  constexpr unsigned int n_founders = 200;

  // det F_g is exp(0.4 t²), exactly, and all rates are 1.5 det F_g.
  const std::vector<std::string> growing = {"Dimension=2",
                                            "Growth/Law=rate",
                                            "Growth/Rate/Rate=0.8*t",
                                            "Cell types/Names=stem, leaf"};

  /** The times of all events, in order. */
  std::vector<double>
  times_of(const std::vector<std::string> &settings, const double step)
  {
    const auto all =
      with(with(growing, settings), {"Time/Step=" + std::to_string(step)});
    const Lives         lives = lead(scene_of(all), n_founders, 1.6, step);
    std::vector<double> times = lives.births;
    for (const CellEvent &event : lives.events)
      if (!(event.kind == CellEvent::removal))
        times.push_back(event.time);
    return times;
  }

  /**
   * The mean error of the events' times, @p delay days after the thresholds of
   * their hazards are reached. They are told from a run with short steps.
   */
  double
  mean_error(const std::vector<std::string> &settings, const double step)
  {
    const std::vector<double> exact = times_of(settings, 0.0025),
                              times = times_of(settings, step);
    double       sum                = 0.;
    const double n                  = std::min(exact.size(), times.size());
    EXPECT_GT(n, 0.7 * n_founders);
    for (std::size_t i = 0; i < n; ++i)
      sum += times[i] - exact[i];
    return std::abs(sum) / n;
  }

  void
  expect_second_order(const std::vector<std::string> &settings)
  {
    const double coarse = mean_error(settings, 0.2),
                 fine   = mean_error(settings, 0.1);
    EXPECT_LT(coarse, 6e-3);
    EXPECT_GT(coarse / fine, 3.);
  }
} // namespace


TEST(LateRates, OfTransitionsAreMadeGood)
{
  expect_second_order({"Cell types/stem/Transitions/To leaf=1.5*growth"});
}


TEST(LateRates, OfDeathAreMadeGood)
{
  expect_second_order({"Death/Rate=1.5*growth", "Death/Shrinking time=0"});
}


TEST(LateRates, OfTheWaitAreMadeGood)
{
  expect_second_order({"Proliferation/Law=cell cycle",
                       "Proliferation/Cell cycle/Duration=0.4",
                       "Proliferation/Cell cycle/G0 exit rate="
                       "1.5*growth*(generation < 1)"});
}


// Negative corrections leave no negative integral, and thresholds that a
// correction passes are passed at the beginning of the step.
TEST(LateRates, CorrectionsAreBounded)
{
  EXPECT_EQ(with_missed(0.1, 0., 5., 0.2), 0.);
  EXPECT_DOUBLE_EQ(with_missed(0.1, 2., 1., 0.2), 0.2);
  EXPECT_EQ(with_missed(0.1, 2., not_expected, 0.2), 0.1);
  EXPECT_EQ(*Hazard({0., 1.1, 1.}).event(3., 4.), 3.);
  EXPECT_EQ(*Hazard({2., 1.1, 1.}).event(3., 4.), 3.);
  EXPECT_FALSE(Hazard({0., 0.9, 1.}).event(3., 4.));
  EXPECT_DOUBLE_EQ(*Hazard({0.5, 0.9, 1.}).event(3., 4.), 3.2);
}
