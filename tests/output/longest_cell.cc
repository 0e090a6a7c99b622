// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "output/room.h"

/** A cell at @p x of 10 µm, stretched by @p stretch along a diagonal. */
template <int dim>
ParticleDomain<dim>
cell(const double x, const double stretch)
{
  Tensor<1, dim> e;
  e[0]                   = 0.6;
  e[1]                   = -0.8;
  const Tensor<2, dim> A = 10. * (Tensor<2, dim>(unit_symmetric_tensor<dim>()) +
                                  (stretch - 1.) * outer_product(e, e));
  Point<dim>           position;
  position[0]       = x;
  position[dim - 1] = -x;
  return ParticleDomain<dim>(position, A);
}


// Cells 0 to 11, stretched by 1 to 2.65, in turn on the ranks.
TEST_2D_3D(LongestCell, IsFoundOnAllRanks)
{
  const unsigned int rank    = this_rank();
  const unsigned int n_ranks = number_of_ranks();
  LongestCell<dim>   cells(40.);
  for (unsigned int i = 0; i < 12; ++i)
    if (i % n_ranks == rank)
      cells.add(cell<dim>(i, 1. + 0.15 * i));
  const CellLengths all = cells.over_all_ranks(MPI_COMM_WORLD);
  EXPECT_NEAR(all.min_cells_per_spacing, 4. / 2.65, 1e-12);
  EXPECT_DOUBLE_EQ(all.place[0], 11.);
  EXPECT_DOUBLE_EQ(all.place[dim - 1], -11.);
  EXPECT_EQ(all.n_too_long, 5u); // 2.05, 2.2, 2.35, 2.5, 2.65
}


TEST(LongestCell, BoundOfTheLength)
{
  std::mt19937 generator(3);
  for (unsigned int i = 0; i < 1000; ++i)
    {
      Tensor<2, 3> A;
      for (unsigned int k = 0; k < 9; ++k)
        A[k / 3][k % 3] = std::normal_distribution<>()(generator);
      if (determinant(A) < 0.)
        A *= -1.;
      const ParticleDomain<3> cell(Point<3>(), A);
      EXPECT_GE(largest_stretch_bound(cell.edge_vectors()), cell.length());
      EXPECT_LE(largest_stretch_bound(cell.edge_vectors()),
                1.16 * cell.length());
    }
  // exact where two of three are equal, and in the plane
  Tensor<2, 3> rod;
  rod[0][0] = rod[1][1] = 1.;
  rod[2][2]             = 5.;
  EXPECT_NEAR(largest_stretch_bound(
                ParticleDomain<3>(Point<3>(), rod).edge_vectors()),
              5.,
              1e-7);
  Tensor<2, 2> sheet;
  sheet[0][0] = sheet[0][1] = sheet[1][1] = 2.;
  const ParticleDomain<2> cell(Point<2>(), sheet);
  EXPECT_NEAR(largest_stretch_bound(cell.edge_vectors()), cell.length(), 1e-7);
}

/** Bounds without roots: true only where the domain's own say so, and true
 *  where the bound of its length does, unless the domain is shortened. */
TEST(DeformedCube, BoundsAreThoseOfTheDomain)
{
  std::mt19937 generator(4);
  unsigned int n_whole = 0;
  for (unsigned int i = 0; i < 1000; ++i)
    {
      DeformedCube<3> cube;
      cube.volume = 8.;
      for (unsigned int k = 0; k < 9; ++k)
        cube.deformation[k / 3][k % 3] =
          std::normal_distribution<>()(generator);
      if (determinant(cube.deformation) < 0.)
        cube.deformation *= -1.;
      const ParticleDomain<3> domain = cube.at(Point<3>());
      const double            length = domain.length();
      EXPECT_FALSE(cube.is_within_length(0.999 * length));
      double reach = 0.;
      for (unsigned int d = 0; d < 3; ++d)
        reach = std::max(
          {reach, domain.bounds().second[d], -domain.bounds().first[d]});
      EXPECT_FALSE(cube.is_within(0.999 * reach));

      const double whole = 2. * largest_stretch_bound(cube.deformation);
      if (largest_stretch_bound(domain.edge_vectors()) < (1. - 1e-6) * whole)
        continue;
      ++n_whole;
      EXPECT_TRUE(cube.is_within_length(1.16 * length));
      EXPECT_TRUE(cube.is_within(1.16 * std::sqrt(3.) / 2. * length));
    }
  EXPECT_GT(n_whole, 900u);
}

TEST(LongestCell, CubesAreTheirDomains)
{
  LongestCell<3> cubes(4.), domains(4.);
  std::mt19937   generator(5);
  for (unsigned int i = 0; i < 500; ++i)
    {
      DeformedCube<3> cube{1., Tensor<2, 3>(unit_symmetric_tensor<3>())};
      for (unsigned int k = 0; k < 9; ++k)
        cube.deformation[k / 3][k % 3] +=
          0.25 * std::normal_distribution<>()(generator);
      if (!(determinant(cube.deformation) > 0.1))
        continue;
      const Point<3> x(i, 0., 0.);
      cubes.add(x, cube);
      domains.add(cube.at(x));
    }
  const CellLengths found    = cubes.over_all_ranks(MPI_COMM_SELF),
                    expected = domains.over_all_ranks(MPI_COMM_SELF);
  EXPECT_EQ(found.min_cells_per_spacing, expected.min_cells_per_spacing);
  EXPECT_EQ(found.place, expected.place);
  EXPECT_EQ(found.n_too_long, expected.n_too_long);
  EXPECT_GT(expected.n_too_long, 0u);
}

TEST(LongestCell, ExactlyTwoPerSpacingAreEnough)
{
  LongestCell<2> cells(20.);
  cells.add(cell<2>(0., 1.));
  EXPECT_EQ(cells.over_all_ranks(MPI_COMM_SELF).n_too_long, 0u);
}
