// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

CellQuantities
cell(const double V0,
     const double det_F,
     const double det_F_g,
     const double J_e,
     const double energy)
{
  CellQuantities q;
  q.initial_volume       = V0;
  q.volume               = V0 * det_F;
  q.growth_volume_ratio  = det_F_g;
  q.elastic_volume_ratio = J_e;
  q.energy_density       = energy;
  return q;
}

/** Two cells on the first and the last rank. */
template <int dim>
void
add_cells(TissueSums<dim> &sums)
{
  const unsigned int rank = this_rank();
  Point<dim>         position;
  position[0] = -3.;
  position[1] = 2.;
  if (rank == 0)
    sums.add_cell(cell(10., 1.5, 2., 0.75, 0.5), position);
  position[0]       = 4.;
  position[dim - 1] = -5.;
  if (rank + 1 == number_of_ranks())
    sums.add_cell(cell(30., 1., 1.25, 1.1, 0.1), position);
}

TEST(TissueSums, AreThoseOfAllRanks)
{
  TissueSums<3> sums;
  add_cells(sums);
  const TissueTotals totals = sums.totals(MPI_COMM_WORLD);
  EXPECT_DOUBLE_EQ(totals.total_volume, 45.);
  EXPECT_DOUBLE_EQ(totals.grown_volume, 57.5);
  EXPECT_DOUBLE_EQ(totals.mean_energy_density, 8. / 40.);
  EXPECT_DOUBLE_EQ(totals.cell_mean_energy_density, 0.3);
  EXPECT_DOUBLE_EQ(totals.max_energy_density, 0.5);
  EXPECT_DOUBLE_EQ(totals.min_elastic_volume_ratio, 0.75);
  EXPECT_DOUBLE_EQ(totals.max_elastic_volume_ratio, 1.1);
}

TEST(TissueSums, TakeTheBoxOfTheBoundaryPoints)
{
  TissueSums<3> sums;
  add_cells(sums);
  TissueTotals totals = sums.totals(MPI_COMM_WORLD);
  EXPECT_EQ(totals.lower, (std::array<double, 3>{{-3., 2., -5.}}));
  EXPECT_EQ(totals.upper, (std::array<double, 3>{{4., 2., 0.}}));

  const double rank = this_rank();
  const double last = number_of_ranks() - 1.;
  sums.add_boundary_point(Point<3>(100. + rank, -rank, 1.));
  totals = sums.totals(MPI_COMM_WORLD);
  EXPECT_EQ(totals.lower, (std::array<double, 3>{{100., -last, 1.}}));
  EXPECT_EQ(totals.upper, (std::array<double, 3>{{100. + last, 0., 1.}}));
}

TEST(TissueSums, HaveNoExtentInZInTwoDimensions)
{
  TissueSums<2> sums;
  add_cells(sums);
  const TissueTotals totals = sums.totals(MPI_COMM_WORLD);
  EXPECT_EQ(totals.lower, (std::array<double, 3>{{-3., -5., 0.}}));
  EXPECT_EQ(totals.upper, (std::array<double, 3>{{4., 2., 0.}}));
}
