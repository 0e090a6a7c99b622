// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "simulation/room.h"

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
  run_field<dim>(
    {"Dimension=" + std::to_string(dim),
     "Time/End time=0.1",
     "Time/Step=0.1",
     "Tissue/Shape=sphere",
     "Tissue/Radius=100",
     "Tissue/Center=7.3, 11.9, -4.1",
     "Tissue/Cell spacing=" + std::to_string(spacing),
     std::string("Tissue/Surface cells=") + (trimmed ? "trimmed" : "whole"),
     "Tissue/Boundary points=" +
       std::to_string(
         int(dim == 2 ? 628. / spacing : 125664. / (spacing * spacing))),
     "Grid/Spacing=" + std::to_string(h),
     "Fields/signal/Diffusion=300",
     "Fields/signal/Consumption=0.1",
     "Fields/signal/Production=" + production,
     "Fields/signal/Fixed where=1",
     "Fields/signal/Value=6 + " + product},
    [&](const auto &cells, const auto &values, const auto &row) {
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
          sums[0] += cells.volume(p) * std::pow(values[p] - 6. - exact, 2);
          sums[1] += cells.volume(p) * std::pow(2. + exact, 2);
        }
      error = std::sqrt(sum_over_ranks(sums[0]) / sum_over_ranks(sums[1]));
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
  run_field<2>(settings,
               [&](const auto &cells, const auto &values, const auto &row) {
                 std::vector<double> sums(4);
                 for (unsigned int p = 0; p < cells.size(); ++p)
                   {
                     sums[0] += cells.volume(p) * values[p];
                     sums[1] += cells.volume(p) * values[p] * values[p];
                     for (unsigned int d = 0; d < 2; ++d)
                       sums[2 + d] += cells.position(p)[d];
                   }
                 Utilities::MPI::sum(sums, MPI_COMM_WORLD, sums);
                 n_cells = sum_over_ranks<std::size_t>(cells.size());
                 const Tensor<1, 2> mean(
                   {sums[2] / n_cells, sums[3] / n_cells});
                 if (row.step == 0)
                   {
                     before = sums[0];
                     spread = sums[1];
                     start  = mean;
                   }
                 way = std::max(way, (mean - start).norm());
                 EXPECT_NEAR(sums[0], before, 1e-12 * before);
                 EXPECT_LE(sums[1], (1. + 1e-12) * spread);
                 EXPECT_EQ(row.of_effect("signal_clipped"), 0.);
                 spread = sums[1];
               });
  EXPECT_GT(n_cells, least_cells);
  return way;
}


// Whole cells at the surface: what lies between them and the surface is
// missing.
TEST(FieldsOfARun, ErrorsFallOnACutDisc)
{
  ONE_RANK_IS_ENOUGH();
  check_order<2>(false, 2., 6e-4);
  check_order<2>(true, 2.5, 2e-4);
}


TEST(FieldsOfARun, ErrorsFallInACutBall)
{
  check_order<3>(true, 2.5, 2e-3);
}


// The held side takes the disc over a grid spacing in each step.
TEST(FieldsOfARun, AmountStaysWhileCellsGrowDivideAndMoveTheGrid)
{
  const double way =
    check_amounts({"Dimension=2",
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
                   "Fields/signal/Initial=2 + sin(X/20) + cos(Y/15)",
                   "Boundary conditions/Fixed where=X < 0",
                   "Boundary conditions/Displacement=400*t; 170*t; 0"},
                  130); // of 112
  EXPECT_GT(way, 200.);
}
