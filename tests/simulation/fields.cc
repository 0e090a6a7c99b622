// ranks: 1 2 4
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "common/temporary_file.h"
#include "output/scratch_directory.h"

using namespace Morula;

namespace
{
  /** A scene of these settings, whose files go into a directory of this test.
   */
  Scene
  read(std::vector<std::string> settings, const ScratchDirectory &directory)
  {
    const TemporaryFile file("fields.prm", "");
    settings.insert(settings.end(),
                    {"Output directory=" + (directory / "run"),
                     "Output/Formats=none",
                     "Fields/Names=signal"});
    Scene scene = Scene::read(file.path, settings);
    scene.check();
    return scene;
  }

  /** Runs a scene; observe(cells, values of the field `signal` by cell, row of
   *  statistics.csv). */
  template <int dim, typename Observe>
  void
  run(const std::vector<std::string> &settings, const Observe &observe)
  {
    const ScratchDirectory directory;
    const Scene            scene = read(settings, directory);
    Simulation<dim>        simulation(scene, MPI_COMM_WORLD, false);
    simulation.run([&]() {
      const Cells<dim>    &cells = simulation.state().cells();
      const Column<double> column =
        cells.columns().template find<double>("signal");
      std::vector<double> values;
      for (unsigned int p = 0; p < cells.size(); ++p)
        values.push_back(cells[p].get(column));
      observe(cells, values, simulation.last_row());
    });
  }

  /** How far the field is from `6 + Π cos`, in L2, relative to `2 + Π cos`. */
  template <int dim>
  double
  error_of_manufactured(const double h, const bool trimmed)
  {
    const double      spacing = 10. * std::pow(h / 40., 1.5);
    const std::string product =
      dim == 2 ? "cos(X/40 + 0.4)*cos(Y/55 - 0.7)" :
                 "cos(X/40 + 0.4)*cos(Y/55 - 0.7)*cos(Z/70 + 0.2)";
    const double squares =
      1. / (40. * 40.) + 1. / (55. * 55.) + (dim == 3 ? 1. / (70. * 70.) : 0.);
    // s = -D Δc + k c
    const std::string production =
      std::to_string(300. * squares + 0.1) + "*" + product + " + 0.6";
    double error = 0.;
    run<dim>({"Dimension=" + std::to_string(dim),
              "Time/End time=0.1",
              "Time/Step=0.1",
              "Tissue/Shape=sphere",
              "Tissue/Radius=100",
              "Tissue/Center=7.3, 11.9, -4.1",
              "Tissue/Cell spacing=" + std::to_string(spacing),
              std::string("Tissue/Surface cells=") +
                (trimmed ? "trimmed" : "whole"),
              "Tissue/Boundary points=" +
                std::to_string(int(dim == 2 ? 628. / spacing :
                                              125664. / (spacing * spacing))),
              "Grid/Spacing=" + std::to_string(h),
              "Fields/signal/Diffusion=300",
              "Fields/signal/Consumption=0.1",
              "Fields/signal/Production=" + production,
              "Fields/signal/Fixed where=1",
              "Fields/signal/Value=6 + " + product},
             [&](const Cells<dim>          &cells,
                 const std::vector<double> &values,
                 const StatisticsRow       &row) {
               if (row.step > 0)
                 return; // cells have moved
               double sums[] = {0., 0.};
               for (unsigned int p = 0; p < cells.size(); ++p)
                 {
                   const double b[]   = {0.4, -0.7, 0.2};
                   const double a[]   = {40., 55., 70.};
                   double       exact = 1.;
                   for (unsigned int d = 0; d < dim; ++d)
                     exact *= std::cos(cells.position(p)[d] / a[d] + b[d]);
                   sums[0] +=
                     cells.volume(p) * std::pow(values[p] - 6. - exact, 2);
                   sums[1] += cells.volume(p) * std::pow(2. + exact, 2);
                 }
               error = std::sqrt(Utilities::MPI::sum(sums[0], MPI_COMM_WORLD) /
                                 Utilities::MPI::sum(sums[1], MPI_COMM_WORLD));
             });
    return error;
  }

  template <int dim>
  void
  check_order(const bool trimmed, const double order, const double finest)
  {
    const double factor = dim == 2 ? 1.5 : 1.25;
    const int    n      = dim == 2 ? 3 : 2;
    const double first  = error_of_manufactured<dim>(40., trimmed);
    const double last =
      error_of_manufactured<dim>(40. / std::pow(factor, n), trimmed);
    EXPECT_LE(last, finest);
    EXPECT_GE(std::log(first / last) / std::log(factor) / n, order)
      << "errors from " << first << " to " << last;
  }

  /** Tests that the amount stays, and that the field only gets smoother; the
   *  largest change of the cells' mean position since t = 0, µm. */
  double
  check_amounts(const std::vector<std::string> &settings,
                const std::size_t               least_cells)
  {
    double       before = 0., spread = 0., way = 0.;
    Tensor<1, 2> start;
    std::size_t  n_cells = 0;
    run<2>(settings,
           [&](const Cells<2>            &cells,
               const std::vector<double> &values,
               const StatisticsRow       &row) {
             std::vector<double> sums(4);
             for (unsigned int p = 0; p < cells.size(); ++p)
               {
                 sums[0] += cells.volume(p) * values[p];
                 sums[1] += cells.volume(p) * values[p] * values[p];
                 for (unsigned int d = 0; d < 2; ++d)
                   sums[2 + d] += cells.position(p)[d];
               }
             Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
             n_cells =
               Utilities::MPI::sum<std::size_t>(cells.size(), MPI_COMM_WORLD);
             const Tensor<1, 2> mean({sums[2] / n_cells, sums[3] / n_cells});
             if (row.step == 0)
               {
                 before = sums[0];
                 spread = sums[1];
                 start  = mean;
               }
             way = std::max(way, (mean - start).norm());
             EXPECT_NEAR(sums[0], before, 1e-12 * before);
             EXPECT_LE(sums[1], (1. + 1e-12) * spread);
             EXPECT_EQ(row.fields[0].clipped, 0u);
             spread = sums[1];
           });
    EXPECT_GT(n_cells, least_cells);
    return way;
  }

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
    run<2>(
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
      [&](const Cells<2>            &cells,
          const std::vector<double> &values,
          const StatisticsRow       &row) {
        if (row.step > 0)
          return;
        // Where nothing is left; 19 % for h = 40 um.
        EXPECT_LE(row.fields[0].clipped, row.cells / 4);
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

  /** What is used up of a field that is 1 at one end of a bar and reaches
   *  @p decay (µm) into it, relative to D/decay and the area. */
  double
  used_up_near_a_wall(const double decay)
  {
    double used = 0.;
    run<2>({"Dimension=2",
            "Time/End time=0.1",
            "Time/Step=0.1",
            "Tissue/Shape=box",
            "Tissue/Center=103, 38",
            "Tissue/Size=200, 80",
            "Tissue/Cell spacing=2",
            "Grid/Spacing=40",
            "Fields/signal/Diffusion=" + std::to_string(decay * decay),
            "Fields/signal/Consumption=1",
            "Fields/signal/Fixed where=X < 3.001",
            "Fields/signal/Value=1"},
           [&](const Cells<2>            &cells,
               const std::vector<double> &values,
               const StatisticsRow       &row) {
             if (row.step > 0)
               return;
             double sum = 0.;
             for (unsigned int p = 0; p < cells.size(); ++p)
               {
                 EXPECT_LE(values[p], 1.);
                 EXPECT_GE(values[p], 0.);
                 sum += cells.volume(p) * values[p];
               }
             used = Utilities::MPI::sum(sum, MPI_COMM_WORLD) / (80. * decay);
           });
    return used;
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

  const std::vector<std::string> dividing_disc = {
    "Dimension=2",
    "Time/End time=0.6",
    "Time/Step=0.1",
    "Tissue/Shape=sphere",
    "Tissue/Radius=60",
    "Tissue/Cell spacing=10",
    "Tissue/Boundary points=60",
    "Grid/Spacing=30",
    "Proliferation/Law=cell cycle",
    "Proliferation/Cell cycle/Duration=0.5",
    "Proliferation/Cell cycle/G0 exit rate=1.5",
    "Fields/signal/Time=transient",
    "Fields/signal/Diffusion=200",
    "Fields/signal/Initial=2 + sin(X/20) + cos(Y/15)"};
} // namespace


// Whole cells at the surface: what lies between them and the surface is
// missing.
TEST(FieldsOfARun, ErrorsFallOnACutDisc)
{
  check_order<2>(false, 2., 6e-4);
  check_order<2>(true, 2.5, 2e-4);
}


TEST(FieldsOfARun, ErrorsFallInACutBall)
{
  check_order<3>(true, 2.5, 2e-3);
}


TEST(FieldsOfARun, AmountStaysWhileCellsGrowMoveAndDivide)
{
  check_amounts(dividing_disc, 130); // of 112
}


// The held side takes the disc over a grid spacing in each step.
TEST(FieldsOfARun, AmountStaysOnAGridThatMoves)
{
  std::vector<std::string> settings = dividing_disc;
  settings.insert(settings.end(),
                  {"Boundary conditions/Fixed where=X < 0",
                   "Boundary conditions/Displacement=400*t; 170*t; 0"});
  EXPECT_GT(check_amounts(settings, 130), 200.);
}


TEST(FieldsOfARun, ErrorsOfAFrontFall)
{
  const double coarse = error_of_front(80.), fine = error_of_front(20.);
  EXPECT_LE(fine, 1e-3);
  EXPECT_GE(std::log(coarse / fine) / std::log(4.), 2.)
    << "errors from " << coarse << " to " << fine;
}


// The grid does not resolve what reaches into less than half of a grid cell. A
// firmer hold at the wall makes up for it: no value is out of bounds, and what
// is used up is that of the layer but for a fifth.
TEST(FieldsOfARun, UptakeInLessThanAGridCell)
{
  EXPECT_NEAR(used_up_near_a_wall(40.), 1., 5e-4);
  EXPECT_NEAR(used_up_near_a_wall(20.), 1., 5e-3);
  EXPECT_NEAR(used_up_near_a_wall(13.), 1., 0.02);
  EXPECT_NEAR(used_up_near_a_wall(10.), 1., 0.04);
  for (const double decay : {5., 2., 1., 0.5})
    EXPECT_NEAR(used_up_near_a_wall(decay), 1., 0.2) << decay << " um";
}


// As much as is made, c^2 = 4, is used up everywhere. Iterations begin at 1.
TEST(FieldsOfARun, UptakeByTheSquareOfTheField)
{
  run<2>({"Dimension=2",
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
TEST(FieldsOfARun, WithoutDiffusionEachCellIsByItself)
{
  std::vector<std::string> settings = jump_in_a_bar("1e-9");
  settings.insert(settings.end(),
                  {"Fields/signal/Consumption=1000*(X > 10) + Y^2",
                   "Fields/signal/Production=3*(X > -20)",
                   "Fields/signal/Initial=(X > 50) + abs(sin(X/3))"});
  run<2>(settings,
         [&](const Cells<2>            &cells,
             const std::vector<double> &values,
             const StatisticsRow       &row) {
           for (unsigned int p = 0; p < cells.size(); ++p)
             {
               const Point<2> X = cells.founder_position(p);
               double         c = (X[0] > 50.) + std::abs(std::sin(X[0] / 3.));
               const double   k = 1000. * (X[0] > 10.) + X[1] * X[1];
               for (unsigned int step = 0; step < row.step; ++step)
                 c = (c + 0.1 * 3. * (X[0] > -20.)) / (1. + 0.1 * k);
               EXPECT_NEAR(values[p], c, 1e-9);
             }
           EXPECT_EQ(row.fields[0].clipped, 0u);
         });
}


// Cells on one side use up all within a step. What diffuses there in a step is
// that of one dimension: little, in less than a grid cell, and in more.
TEST(FieldsOfARun, AJumpOfTheUptake)
{
  for (const double diffusion : {16., 160., 1600., 16000., 160000.})
    {
      std::vector<std::string> settings =
        jump_in_a_bar(std::to_string(diffusion));
      settings.insert(settings.end(),
                      {"Fields/signal/Consumption=1000*(X > 10)",
                       "Fields/signal/Initial=1"});
      JumpInABar exact(diffusion, 1000.);
      double     before = 0.;
      run<2>(settings,
             [&](const Cells<2>            &cells,
                 const std::vector<double> &values,
                 const StatisticsRow       &row) {
               std::vector<double> sums(2);
               for (unsigned int p = 0; p < cells.size(); ++p)
                 {
                   const double amount = cells.volume(p) * values[p];
                   sums[0] += amount;
                   if (cells.founder_position(p)[0] > 10.)
                     sums[1] += 0.1 * 1000. * amount; // used up in the step
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
TEST(FieldsOfARun, ValuesSetToZeroChangeNoBalance)
{
  run<2>({"Dimension=2",
          "Time/End time=0.1",
          "Time/Step=0.1",
          "Tissue/Shape=sphere",
          "Tissue/Radius=60",
          "Tissue/Cell spacing=6",
          "Grid/Spacing=30",
          "Fields/signal/Diffusion=1e3",
          "Fields/signal/Production=5*(X > 10)",
          "Fields/signal/Consumption=1e3"},
         [&](const Cells<2>            &cells,
             const std::vector<double> &values,
             const StatisticsRow       &row) {
           std::vector<double> sums(2);
           for (unsigned int p = 0; p < cells.size(); ++p)
             {
               const double X = cells.founder_position(p)[0];
               sums[0] += cells.volume(p) * values[p] * 1e3;
               sums[1] += cells.volume(p) * 5. * (X > 10.);
               EXPECT_GE(values[p], 0.);
             }
           Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
           // The first step has the configuration of t = 0.
           EXPECT_EQ(row.fields[0].clipped > 0, row.step == 0);
           EXPECT_NEAR(sums[0], sums[1], 1e-9 * sums[1]);
         });
}
