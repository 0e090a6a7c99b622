// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "simulation/room.h"

/** c where q is used up as long as there is some, in a disc of radius R (µm)
 *  at whose surface it is 1, around a core with nothing: q / D. */
double
uptake_of_core(const double R, const double core)
{
  return 4. / (R * R - core * core - 2. * core * core * std::log(R / core));
}

/** The error of c in that disc, in L2 of its volume, at t = 0. */
double
error_of_front(const double h)
{
  constexpr double R = 300., core = 150., D = 1e6;
  const double     q     = uptake_of_core(R, core) * D;
  double           error = 0.;
  run_field<2>(
    {"Dimension=2",
     "Time/End time=0.1",
     "Tissue/Shape=sphere",
     "Tissue/Radius=300",
     "Tissue/Center=7.3, 11.9",
     "Tissue/Surface cells=trimmed",
     "Tissue/Cell spacing=" + std::to_string(h / 4.),
     "Tissue/Boundary points=" + std::to_string(int(7500. / h)),
     "Grid/Spacing=" + std::to_string(h),
     "Fields/signal/Diffusion=" + std::to_string(D),
     "Fields/signal/Consumption=" + std::to_string(q) + "/(0.0005 + signal)",
     "Fields/signal/Initial=1",
     "Fields/signal/Fixed where=1",
     "Fields/signal/Value=1"},
    [&](const auto &cells, const auto &values, const auto &row) {
      if (row.step > 0)
        return;
      // Where nothing is left; 19 % for h = 40 um.
      EXPECT_LE(row.of_effect("signal_clipped"), row.cells / 4);
      std::vector<double> sums(2);
      for (unsigned int p = 0; p < cells.size(); ++p)
        {
          const double r = cells.position(p).distance(Point<2>(7.3, 11.9));
          const double exact =
            r < core ? 0. : uptake_of_core(R, core) / uptake_of_core(r, core);
          sums[0] += cells.volume(p) * std::pow(values[p] - exact, 2);
          sums[1] += cells.volume(p);
        }
      Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
      error = std::sqrt(sums[0] / sums[1]);
    });
  return error;
}


/** A bar from -100 to 100 µm, with five grid cells and no cell at their
 *  faces; steps of 0.1 day. */
std::vector<std::string>
jump_in_a_bar(const std::string &diffusion)
{
  return {"Dimension=2",
          "Time/End time=0.5",
          "Time/Step=0.1",
          "Tissue/Shape=box",
          "Tissue/Size=200, 80",
          "Tissue/Cell spacing=4",
          "Grid/Spacing=40",
          "Fields/signal/Time=transient",
          "Fields/signal/Diffusion=" + diffusion};
}

/** A field in that bar by finite differences, 1 at first, and used up at the
 *  rate k (1/day) beyond 10 µm. */
struct JumpInABar
{
  JumpInABar(const double diffusion, const double k)
    : coupling(diffusion / (spacing * spacing))
    , k(k)
    , c(4000, 1.)
  {}

  /** Of implicit Euler. */
  void
  step(const double dt)
  {
    const unsigned int  n = c.size();
    std::vector<double> upper(n);
    for (unsigned int i = 0; i < n; ++i) // Thomas' algorithm
      {
        const double x        = -100. + (i + 0.5) * spacing;
        const double lower    = i > 0 ? -coupling : 0.;
        const double diagonal = 1. / dt + k * (x > 10.) +
                                coupling * ((i > 0) + (i + 1 < n)) -
                                (i > 0 ? lower * upper[i - 1] : 0.);
        upper[i] = i + 1 < n ? -coupling / diagonal : 0.;
        c[i]     = (c[i] / dt - (i > 0 ? lower * c[i - 1] : 0.)) / diagonal;
      }
    for (unsigned int i = n - 1; i > 0; --i)
      c[i - 1] -= upper[i - 1] * c[i];
  }

  double
  mean() const
  {
    return std::accumulate(c.begin(), c.end(), 0.) / c.size();
  }

  static constexpr double spacing = 0.05; // µm
  const double            coupling, k;
  std::vector<double>     c;
};


TEST(UptakeOfAField, ErrorsOfAFrontFall)
{
  ONE_RANK_IS_ENOUGH();
  const double coarse = error_of_front(80.), fine = error_of_front(20.);
  EXPECT_LE(fine, 1e-3);
  EXPECT_GE(std::log(coarse / fine) / std::log(4.), 2.)
    << "errors from " << coarse << " to " << fine;
}


// As much as is made, c^2 = 4, is used up everywhere. Iterations begin at 1.
TEST(UptakeOfAField, UptakeByTheSquareOfTheField)
{
  ONE_RANK_IS_ENOUGH();
  run_field<2>({"Dimension=2",
                "Time/End time=0.1",
                "Fields/signal/Diffusion=100",
                "Fields/signal/Initial=1",
                "Fields/signal/Production=4",
                "Fields/signal/Consumption=signal"},
               [](const auto &, const auto &values, const auto &) {
                 for (const double value : values)
                   EXPECT_NEAR(value, 2., 1e-9);
               });
}


// What cells use up, make and have differs from one to the next, and nothing
// moves: each has the value of implicit Euler steps of its own.
TEST(UptakeOfAField, WithoutDiffusionEachCellIsByItself)
{
  std::vector<std::string> settings = jump_in_a_bar("1e-9");
  settings.insert(settings.end(),
                  {"Fields/signal/Consumption=1000*(X > 10) + Y^2",
                   "Fields/signal/Production=3*(X > -20)",
                   "Fields/signal/Initial=(X > 50) + abs(sin(X/3))"});
  run_field<2>(settings,
               [&](const auto &cells, const auto &values, const auto &row) {
                 for (unsigned int p = 0; p < cells.size(); ++p)
                   {
                     const Point<2> X = cells[p].founder_position();
                     double c = (X[0] > 50.) + std::abs(std::sin(X[0] / 3.));
                     const double k = 1000. * (X[0] > 10.) + X[1] * X[1];
                     for (unsigned int step = 0; step < row.step; ++step)
                       c = (c + 0.1 * 3. * (X[0] > -20.)) / (1. + 0.1 * k);
                     EXPECT_NEAR(values[p], c, 1e-9);
                   }
                 EXPECT_EQ(row.of_effect("signal_clipped"), 0.);
               });
}


// Cells on one side use up all within a step. What diffuses there in a step is
// that of one dimension: little, in less than a grid cell, and in more.
TEST(UptakeOfAField, AJumpOfTheUptake)
{
  ONE_RANK_IS_ENOUGH();
  for (const double diffusion : {16., 160., 1600., 16000., 160000.})
    {
      std::vector<std::string> settings =
        jump_in_a_bar(std::to_string(diffusion));
      settings.insert(settings.end(),
                      {"Fields/signal/Consumption=1000*(X > 10)",
                       "Fields/signal/Initial=1"});
      JumpInABar exact(diffusion, 1000.);
      double     before = 0.;
      run_field<2>(settings,
                   [&](const auto &cells, const auto &values, const auto &row) {
                     std::vector<double> sums(2);
                     for (unsigned int p = 0; p < cells.size(); ++p)
                       {
                         const double amount = cells.volume(p) * values[p];
                         sums[0] += amount;
                         if (cells[p].founder_position()[0] > 10.)
                           sums[1] +=
                             0.1 * 1000. * amount; // used up in the step
                         EXPECT_GE(values[p], 0.);
                         EXPECT_LE(values[p], 1.1);
                       }
                     Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
                     if (row.step > 0)
                       {
                         exact.step(0.1);
                         EXPECT_NEAR(sums[0] + sums[1], before, 1e-12 * before);
                         EXPECT_NEAR(sums[0] / 16000., exact.mean(), 0.03)
                           << "D = " << diffusion << ", step " << row.step;
                       }
                     before = sums[0];
                   });
    }
}


// Only some cells make the field, and it reaches 1 um. What comes out negative
// is set to 0, and what is used up stays as much as is made.
TEST(UptakeOfAField, ValuesSetToZeroChangeNoBalance)
{
  run_field<2>({"Dimension=2",
                "Time/End time=0.1",
                "Time/Step=0.1",
                "Tissue/Shape=sphere",
                "Tissue/Radius=60",
                "Tissue/Cell spacing=6",
                "Grid/Spacing=30",
                "Fields/signal/Diffusion=1e3",
                "Fields/signal/Production=5*(X > 10)",
                "Fields/signal/Consumption=1e3"},
               [&](const auto &cells, const auto &values, const auto &row) {
                 std::vector<double> sums(2);
                 for (unsigned int p = 0; p < cells.size(); ++p)
                   {
                     const double X = cells[p].founder_position()[0];
                     sums[0] += cells.volume(p) * values[p] * 1e3;
                     sums[1] += cells.volume(p) * 5. * (X > 10.);
                     EXPECT_GE(values[p], 0.);
                   }
                 Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
                 // The first step has the configuration of t = 0.
                 EXPECT_EQ(row.of_effect("signal_clipped") > 0, row.step == 0);
                 EXPECT_NEAR(sums[0], sums[1], 1e-9 * sums[1]);
               });
}
