// ranks: 1 2 4
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/simulation.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cmath>
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

  /** Runs a scene; observe(tissue, values of the field `signal` by cell). */
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
      observe(cells, values);
    });
  }

  /** How far the field is from `6 + Π cos`, in L2, relative to `2 + Π cos`. */
  template <int dim>
  double
  error_of_manufactured(const double h, const bool trimmed)
  {
    const double      spacing = 10. * std::pow(h / 40., 1.5);
    const std::string product =
      dim == 2 ? "cos(x/40 + 0.4)*cos(y/55 - 0.7)" :
                 "cos(x/40 + 0.4)*cos(y/55 - 0.7)*cos(z/70 + 0.2)";
    const std::string at_surface =
      dim == 2 ? "6 + cos(X/40 + 0.4)*cos(Y/55 - 0.7)" :
                 "6 + cos(X/40 + 0.4)*cos(Y/55 - 0.7)*cos(Z/70 + 0.2)";
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
              "Fields/signal/Value=" + at_surface},
             [&](const Cells<dim> &cells, const std::vector<double> &values) {
               if (error > 0.)
                 return; // after the step cells have moved
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
  double      before = 0., spread = 0.;
  std::size_t n_cells = 0;
  run<2>(dividing_disc,
         [&](const Cells<2> &cells, const std::vector<double> &values) {
           double amount = 0., square = 0.;
           for (unsigned int p = 0; p < cells.size(); ++p)
             {
               amount += cells.volume(p) * values[p];
               square += cells.volume(p) * values[p] * values[p];
             }
           amount = Utilities::MPI::sum(amount, MPI_COMM_WORLD);
           square = Utilities::MPI::sum(square, MPI_COMM_WORLD);
           n_cells =
             Utilities::MPI::sum<std::size_t>(cells.size(), MPI_COMM_WORLD);
           if (before == 0.)
             {
               before = amount;
               spread = square;
             }
           EXPECT_NEAR(amount, before, 1e-12 * before);
           EXPECT_LE(square, (1. + 1e-12) * spread);
           spread = square;
         });
  EXPECT_GT(n_cells, 130u); // of 112
}


// Where k is 0 but for a few cells, the field varies within less than a grid
// cell; it must not get negative.
TEST(FieldsOfARun, NoValueIsNegative)
{
  for (const std::string time : {"steady", "transient"})
    run<2>({"Dimension=2",
            "Time/End time=0.2",
            "Time/Step=0.1",
            "Tissue/Shape=sphere",
            "Tissue/Radius=60",
            "Tissue/Cell spacing=6",
            "Grid/Spacing=30",
            "Fields/signal/Time=" + time,
            "Fields/signal/Diffusion=20",
            "Fields/signal/Initial=X > 0",
            "Fields/signal/Consumption=1e3*(X < 10)",
            "Fields/signal/Fixed where=X > 40",
            "Fields/signal/Value=1"},
           [&](const Cells<2> &, const std::vector<double> &values) {
             for (const double value : values)
               {
                 EXPECT_GE(value, 0.);
                 EXPECT_LE(value, 1.2);
               }
           });
}
