// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "seeding/room.h"

/** All ranks' founders, as whole cells, in id order; checks the ids. */
template <int dim>
std::vector<Point<dim>>
seed_and_gather(TissueParameters &parameters)
{
  parameters.surface_cells = "whole";
  parameters.check(dim);
  const auto mine = seed_founders<dim>(parameters, MPI_COMM_WORLD);
  EXPECT_EQ(mine.volumes.size(), mine.positions.size());
  for (const double volume : mine.volumes)
    EXPECT_DOUBLE_EQ(volume, std::pow(parameters.cell_spacing.value(), dim));

  std::vector<Point<dim>> all;
  const unsigned int      rank = this_rank();
  const auto              pieces =
    Utilities::MPI::all_gather(MPI_COMM_WORLD, mine.positions);
  for (unsigned int r = 0; r < pieces.size(); ++r)
    {
      if (r == rank)
        {
          EXPECT_EQ(mine.first_id, all.size());
        }
      all.insert(all.end(), pieces[r].begin(), pieces[r].end());
    }
  EXPECT_EQ(mine.n_global, all.size());
  return all;
}

template <int dim>
void
expect_same(const std::vector<Point<dim>> &found,
            const std::vector<Point<dim>> &expected)
{
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    ASSERT_LT(found[i].distance(expected[i]), 1e-10) << "cell " << i;
}

/** Cells of the centred sphere in integers: (2i+1)² sums < (2R/L_p)². */
std::size_t
count_in_sphere(const int two_radii_per_spacing)
{
  const int   n     = two_radii_per_spacing;
  std::size_t count = 0;
  for (int a = -n - n % 2 - 1; a <= n + 1; a += 2)
    for (int b = -n - n % 2 - 1; b <= n + 1; b += 2)
      for (int c = -n - n % 2 - 1; c <= n + 1; c += 2)
        if (a * a + b * b + c * c < n * n)
          ++count;
  return count;
}

TEST(Seeding, SphereOfThePaper)
{
  TissueParameters parameters;
  const auto       cells = seed_and_gather<3>(parameters);
  EXPECT_EQ(cells.size(), 65752u);
  EXPECT_EQ(cells.size(), count_in_sphere(50));
  expect_same<3>(cells,
                 lattice_points<3>(Point<3>(), 260., 10., [](const auto &x) {
                   return x.norm() < 250. - 1e-8;
                 }));
}

TEST(Seeding, FineSphereOfThePaper)
{
  TissueParameters parameters;
  parameters.cell_spacing = 5.;
  const auto founders     = seed_founders<3>(parameters, MPI_COMM_WORLD);
  EXPECT_EQ(founders.n_global, count_in_sphere(100));
  EXPECT_NEAR(founders.n_global, 5.2e5, 0.05e5);
  // nobody holds all
  if (number_of_ranks() > 1)
    {
      EXPECT_LT(founders.positions.size(), 0.8 * founders.n_global);
    }
}

TEST(Seeding, BoxIsMeasuredFromItsCorner)
{
  TissueParameters parameters;
  parameters.shape  = "box";
  parameters.center = {7., 0., 100.};
  const auto cells  = seed_and_gather<3>(parameters);
  EXPECT_EQ(cells.size(), 8000u);
  EXPECT_LT(cells.front().distance(Point<3>(-88., -95., 5.)), 1e-12);
  EXPECT_LT(cells[1].distance(Point<3>(-78., -95., 5.)), 1e-12);
  EXPECT_LT(cells[20].distance(Point<3>(-88., -85., 5.)), 1e-12);
  EXPECT_LT(cells.back().distance(Point<3>(102., 95., 195.)), 1e-12);

  // sites on the surface are outside: 20.5 spacings hold 20 cells
  parameters.size = {205., 195., 200.};
  EXPECT_EQ(seed_and_gather<3>(parameters).size(), 20u * 19u * 20u);
}

TEST(Seeding, OffsetAndCenterMoveTheLattice)
{
  TissueParameters parameters;
  parameters.radius         = 60.;
  parameters.cell_spacing   = 7.;
  parameters.center         = {1., -20., 3.};
  parameters.lattice_offset = {3.5, 1., -300.};
  expect_same<3>(seed_and_gather<3>(parameters),
                 lattice_points<3>(Point<3>(4.5, -19., 3. - 300. + 43. * 7.),
                                   77.,
                                   7.,
                                   [](const Point<3> &x) {
                                     return x.distance(Point<3>(1., -20., 3.)) <
                                            60. - 7e-9;
                                   }));

  parameters.shape = "box";
  parameters.size  = {70., 70., 70.};
  // offset 3.5 leaves 9 in x where 0 and 1 leave 10
  parameters.lattice_offset = {3.5, 0., 1.};
  EXPECT_EQ(seed_and_gather<3>(parameters).size(), 9u * 10u * 10u);
}

TEST(Seeding, EllipsoidAndCylinder)
{
  TissueParameters parameters;
  parameters.shape  = "ellipsoid";
  parameters.size   = {100., 160., 60.};
  parameters.center = {5., 0., 0.};
  expect_same<3>(
    seed_and_gather<3>(parameters),
    lattice_points<3>(Point<3>(5., 0., 0.), 100., 10., [](const Point<3> &x) {
      return std::pow((x[0] - 5.) / 50., 2) + std::pow(x[1] / 80., 2) +
               std::pow(x[2] / 30., 2) <
             1. - 1e-9;
    }));

  parameters.shape  = "cylinder";
  parameters.radius = 40.;
  expect_same<3>(
    seed_and_gather<3>(parameters),
    lattice_points<3>(Point<3>(5., 0., 0.), 100., 10., [](const Point<3> &x) {
      return std::hypot(x[0] - 5., x[1]) < 40. - 1e-8 &&
             std::abs(x[2]) < 30. - 1e-8;
    }));
}

TEST(Seeding, TwoDimensions)
{
  TissueParameters parameters;
  parameters.radius = 100.;
  expect_same<2>(
    seed_and_gather<2>(parameters),
    lattice_points<2>(Point<2>(), 110., 10., [](const Point<2> &x) {
      return x.norm() < 100. - 1e-8;
    }));

  parameters.shape  = "box";
  parameters.size   = {40., 20.};
  parameters.center = {20., 10.};
  const auto box    = seed_and_gather<2>(parameters);
  ASSERT_EQ(box.size(), 8u);
  EXPECT_LT(box[5].distance(Point<2>(15., 15.)), 1e-12);

  parameters.shape = "ellipsoid";
  parameters.size  = {100., 60.};
  expect_same<2>(
    seed_and_gather<2>(parameters),
    lattice_points<2>(Point<2>(20., 10.), 80., 10., [](const Point<2> &x) {
      return std::pow((x[0] - 20.) / 50., 2) + std::pow((x[1] - 10.) / 30., 2) <
             1. - 1e-9;
    }));
}

TEST(Seeding, OneCellIsEnoughAndNoneIsRefused)
{
  TissueParameters parameters;
  parameters.radius         = 6.;
  parameters.lattice_offset = {5., 5., 5.};
  const auto cells          = seed_and_gather<3>(parameters);
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_LT(cells[0].norm(), 1e-12);

  parameters.lattice_offset = {0., 0., 0.};
  EXPECT_THROW(parameters.check(3), InputError);
  EXPECT_THROW(seed_founders<3>(parameters, MPI_COMM_WORLD), InputError);
}
