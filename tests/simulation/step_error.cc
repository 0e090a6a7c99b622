// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
// ranks: 1 3

#include "simulation/room.h"

/** 60 cells of different volumes on all ranks. */
void
fill(Tissue<2> &tissue, const CellColumns<2> &columns)
{
  PointList<2>       cells(columns.n_numbers());
  const unsigned int n    = number_of_ranks();
  const unsigned int rank = this_rank();
  for (unsigned int i = rank; i < 60; i += n)
    {
      const Point<2> X(20. * i, 0.);
      const auto     row = columns.founder(X, 100. + i);
      cells.add(i, X, make_array_view(row));
    }
  tissue.place(std::move(cells), PointList<2>());
}


TEST(StepError, IsAMeanOverTheTissue)
{
  const CellColumns<2> columns;
  Tissue<2>            tissue(GridParameters(), columns, MPI_COMM_WORLD);
  fill(tissue, columns);
  const auto  &cells = tissue.cells();
  const double mean  = mean_over_tissue<2>(
    tissue,
    [&](const unsigned int p) { return 1e-3 * std::sqrt(cells.id(p)); },
    100.);
  double    sum = 0., whole = 0.;
  long long units = 0, of_all = 0;
  for (unsigned int i = 0; i < 60; ++i)
    {
      sum += (100. + i) * 1e-3 * std::sqrt(i);
      whole += 100. + i;
      const double volume = std::ldexp((100. + i) / 100., 30);
      units += std::llround(volume * 1e-3 * std::sqrt(i));
      of_all += std::llround(volume);
    }
  EXPECT_NEAR(mean, sum / whole, 1e-9);
  // The same digits on any ranks.
  EXPECT_EQ(mean, double(units) / double(of_all));
  EXPECT_EQ(mean_over_tissue<2>(
              tissue, [](const unsigned int) { return 7.; }, 100.),
            1.);
}


TEST(StepError, OfARunAddsChangesAndTheLast)
{
  // 5/6 of each change of what is missed of growth, and of what is missed of
  // flow along an axis; at last what the last step missed of growth.
  ErrorInTime error;
  EXPECT_EQ(error.total(), 0.);
  error.add<2>(0.03);
  EXPECT_DOUBLE_EQ(error.total(), 0.025 + 0.03);
  error.flow = 0.012 * std::sqrt(2.);
  error.add<2>(0.03);
  EXPECT_DOUBLE_EQ(error.total(), 0.025 + 0.01 + 0.03);
  error.flow = 0.;
  error.add<2>(0.006);
  EXPECT_DOUBLE_EQ(error.total(), 0.025 + 0.01 + 0.02 + 0.006);
}
