// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/seeding/bodies.h>

#include "seeding/room.h"

const double pi = numbers::PI;

/** L_p of the lattices, and the spacing of the grid, um. */
constexpr double length = 10., spacing = 20.;

/** The sites of a lattice around the origin where @p is_cell holds, which is
 *  asked in units of its spacing. */
template <int dim>
std::vector<Point<dim>>
lattice(const int n, const std::function<bool(const Point<dim> &)> &is_cell)
{
  std::vector<Point<dim>> sites;
  const int               n_z = dim == 3 ? n : 1;
  for (int k = 0; k < n_z; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        {
          Point<dim> x;
          for (unsigned int d = 0; d < dim; ++d)
            x[d] = (d == 0 ? i : d == 1 ? j : k) - 0.5 * (n - 1);
          if (is_cell(x))
            sites.push_back(length * x);
        }
  return sites;
}

template <int dim>
std::vector<Point<dim>>
ball(const double radius, const double hole = 0.)
{
  return lattice<dim>(2 * static_cast<int>(radius) + 2,
                      [=](const Point<dim> &x) {
                        return x.norm() < radius && x.norm() >= hole;
                      });
}

template <int dim>
Founders<dim>
founders(const std::vector<Point<dim>> &cells,
         const MPI_Comm                 comm,
         const double volume = Utilities::fixed_power<dim>(length))
{
  const auto [begin, end] = share(cells.size(), comm);
  Founders<dim> mine;
  mine.first_id = begin;
  mine.n_global = cells.size();
  mine.positions.assign(cells.begin() + begin, cells.begin() + end);
  mine.volumes.assign(end - begin, volume);
  return mine;
}

/** All ranks' patches, which are those that one rank alone makes.
 *  @param h spacing of the grid */
template <int dim>
SurfacePatches<dim>
surface(const std::vector<Point<dim>> &cells,
        const unsigned int             n_wished = 0,
        const double volume = Utilities::fixed_power<dim>(length),
        const double h      = spacing)
{
  TissueParameters parameters;
  parameters.shape           = "points";
  parameters.boundary_points = n_wished;
  GridParameters grid;
  grid.spacing    = h;
  const auto mine = seed_points_surface(parameters,
                                        grid,
                                        founders(cells, MPI_COMM_WORLD, volume),
                                        MPI_COMM_WORLD);
  if (number_of_ranks() == 1)
    return mine;
  const auto all = seed_points_surface(parameters,
                                       grid,
                                       founders(cells, MPI_COMM_SELF, volume),
                                       MPI_COMM_SELF);
  EXPECT_EQ(mine.n_global, all.n_global);
  EXPECT_EQ(sum_over_ranks(mine.positions.size()), all.positions.size());
  for (std::size_t i = 0; i < mine.positions.size(); ++i)
    {
      EXPECT_EQ(mine.positions[i], all.positions.at(mine.first_id + i));
      EXPECT_EQ(mine.normals.at(i), all.normals.at(mine.first_id + i));
      EXPECT_EQ(mine.areas.at(i), all.areas.at(mine.first_id + i));
    }
  return all;
}

/** Founders in a disc, or a ball, of two bodies in stripes of so many cells. */
template <int dim>
Founders<dim>
stripes(const double radius, const int width, const MPI_Comm comm)
{
  auto mine = founders(ball<dim>(radius), comm);
  for (const Point<dim> &x : mine.positions)
    mine.bodies.push_back(
      static_cast<int>(std::floor(x[0] / (width * length)) + 1000) % 2);
  return mine;
}

/** All ranks' patches around bodies, on any rank. */
template <int dim>
SurfacePatches<dim>
surface_of_bodies(const Founders<dim> &founders, const MPI_Comm comm)
{
  TissueParameters parameters;
  parameters.shape = "points";
  GridParameters grid;
  grid.spacing = 3. * length;
  auto patches = seed_points_surface(parameters, grid, founders, comm);
  EXPECT_EQ(patches.bodies.size(), patches.areas.size());
  patches.positions = of_all_ranks(patches.positions, comm);
  patches.normals   = of_all_ranks(patches.normals, comm);
  patches.areas     = of_all_ranks(patches.areas, comm);
  patches.bodies    = of_all_ranks(patches.bodies, comm);
  return patches;
}

/** Checks that the surface is closed and encloses the volume of @p n cells. */
template <int dim>
void
expect_encloses(const SurfacePatches<dim> &patches, const double n)
{
  const Sums<dim> sums(patches);
  EXPECT_LT(sums.openness(), 1e-12);
  const double volume = n * Utilities::fixed_power<dim>(length);
  EXPECT_NEAR(sums.volume / volume, 1., 1e-6);
}

/** Largest distance from a sphere around the origin, in cells, and largest
 *  angle between normals and rays, in degrees. */
template <int dim>
std::pair<double, double>
departure(const SurfacePatches<dim> &patches, const double radius)
{
  double distance = 0., angle = 0.;
  for (std::size_t i = 0; i < patches.positions.size(); ++i)
    {
      const Point<dim> &x = patches.positions[i];
      distance = std::max(distance, std::abs(x.norm() - radius) / length);
      angle =
        std::max(angle,
                 std::acos(std::min(1., patches.normals[i] * x / x.norm())));
    }
  return {distance, angle * 180. / pi};
}


/** The radius of a ball of so many cells. */
template <int dim>
double
radius_of(const std::size_t n)
{
  return length * (dim == 2 ? std::sqrt(n / pi) : std::cbrt(0.75 * n / pi));
}


TEST_2D_3D(PointsSurface, OfABall)
{
  ONE_RANK_IS_ENOUGH();
  const auto   cells   = ball<dim>(dim == 2 ? 30. : 10.);
  const auto   patches = surface(cells, 0, std::pow(length, dim), 30.);
  const double radius  = radius_of<dim>(cells.size());
  expect_encloses(patches, cells.size());
  if (dim == 2)
    // A circle crosses each line of the lattice twice.
    EXPECT_NEAR(patches.n_global, 24. * radius / (2.5 * length), 10.);
  else
    EXPECT_NEAR(Sums<dim>(patches).area, 4. * pi * radius * radius, 2e3);
  const auto [distance, angle] = departure(patches, radius);
  EXPECT_LT(distance, 0.5);
  EXPECT_LT(angle, 30.);
}


// Its sides are flat and where the cells end, away from the round edges.
TEST_2D_3D(PointsSurface, OfACube)
{
  ONE_RANK_IS_ENOUGH();
  const int  n       = dim == 2 ? 50 : 16;
  const auto cells   = lattice<dim>(n, [](const auto &) { return true; });
  const auto patches = surface(cells);
  expect_encloses(patches, cells.size());
  const double half = 0.5 * n * length;
  for (std::size_t i = 0; i < patches.positions.size(); ++i)
    {
      const Point<dim> &x       = patches.positions[i];
      bool              is_side = x[dim - 1] > half - 20.;
      for (unsigned int d = 0; d + 1 < dim; ++d)
        is_side = is_side && std::abs(x[d]) < half - 20.;
      if (is_side)
        {
          EXPECT_NEAR(x[dim - 1], half, dim == 2 ? 0.3 : 0.6);
          EXPECT_NEAR(patches.normals[i][dim - 1], 1., 1e-3);
        }
    }
}


TEST_2D_3D(PointsSurface, CavityHasASurface)
{
  if (dim == 3)
    ONE_RANK_IS_ENOUGH();
  const double hole    = dim == 2 ? 8. : 7.;
  const auto   cells   = ball<dim>(dim == 2 ? 20. : 12., hole);
  const auto   patches = surface(cells);
  expect_encloses(patches, cells.size());
  const Sums<dim> inner(patches, [](const Point<dim> &x) {
    return x.norm() < (dim == 2 ? 140. : 95.);
  });
  EXPECT_LT(inner.openness(), 1e-10);
  EXPECT_NEAR(-inner.volume,
              ball<dim>(hole).size() * Utilities::fixed_power<dim>(length),
              dim == 2 ? 400. : 1e5);
}


TEST_2D_3D(PointsSurface, TwoBodies)
{
  const auto cells   = lattice<dim>(32, [](Point<dim> x) {
    x[0] = std::abs(x[0]) - 9.;
    return x.norm() < 6.;
  });
  const auto patches = surface(cells);
  expect_encloses(patches, cells.size());
  const Sums<dim> left(patches, [](const auto &x) { return x[0] < 0.; });
  EXPECT_LT(left.openness(), dim == 2 ? 1e-12 : 1e-10);
  EXPECT_NEAR(left.volume,
              0.5 * cells.size() * Utilities::fixed_power<dim>(length),
              dim == 2 ? 100. : 5e3);
}


// Also where they are thinner than the lattice of the grid can tell.
TEST_2D_3D(PointsSurface, BodiesInStripes)
{
  ONE_RANK_IS_ENOUGH();
  const double radius = dim == 2 ? 10. : 4.;
  for (const int width : {1, 2, 3, 4})
    {
      const auto mine    = stripes<dim>(radius, width, MPI_COMM_SELF);
      const auto patches = surface_of_bodies(mine, MPI_COMM_SELF);
      for (unsigned int body = 0; body < 2; ++body)
        {
          Tensor<1, dim> vector;
          double         enclosed = 0., area = 0.;
          for (std::size_t k = 0; k < patches.areas.size(); ++k)
            if (patches.bodies[k] == body)
              {
                const auto A = patches.areas[k] * patches.normals[k];
                vector += A;
                area += patches.areas[k];
                enclosed += A * patches.positions[k] / dim;
              }
          EXPECT_LT(vector.norm(), 1e-9 * area);
          const double volume =
            std::count(mine.bodies.begin(), mine.bodies.end(), body) *
            Utilities::fixed_power<dim>(length);
          EXPECT_NEAR(enclosed / volume, 1., 0.02) << width;
          // Each stripe has a surface of its own, with two sides.
          EXPECT_GT(area, 1.6 * volume / (width * length)) << width;
        }
    }
}

TEST_2D_3D(PointsSurface, OfBodiesIsEqualToTheBitOnAnyNumberOfRanks)
{
  for (const int width : {1, 2})
    {
      const auto many =
        surface_of_bodies(stripes<dim>(3., width, MPI_COMM_WORLD),
                          MPI_COMM_WORLD);
      const auto one = surface_of_bodies(stripes<dim>(3., width, MPI_COMM_SELF),
                                         MPI_COMM_SELF);
      EXPECT_EQ(many.positions, one.positions);
      EXPECT_EQ(many.normals, one.normals);
      EXPECT_EQ(many.areas, one.areas);
      EXPECT_EQ(many.bodies, one.bodies);
    }
}


TEST(PointsSurface, DoesNotSeeTheLatticesDirection)
{
  ONE_RANK_IS_ENOUGH();
  // the half space below a plane that is oblique to the lattice
  const Tensor<1, 3> N       = Point<3>(1., 2., 3.) / std::sqrt(14.);
  const auto         cells   = lattice<3>(20, [&](const Point<3> &x) {
    return x.norm() < 10. && N * x < 0.;
  });
  const auto         patches = surface(cells);
  expect_encloses(patches, cells.size());
  double height = 0., area = 0.;
  for (std::size_t i = 0; i < patches.positions.size(); ++i)
    {
      const Point<3> &x = patches.positions[i];
      if (patches.normals[i] * N > 0.5 && x.norm() < 60.)
        {
          height += patches.areas[i] * (N * x);
          area += patches.areas[i];
        }
    }
  EXPECT_NEAR(height / area, 0., 2.);
}

TEST(PointsSurface, ScatteredCells)
{
  ONE_RANK_IS_ENOUGH();
  auto                                   cells = ball<3>(10.);
  std::mt19937                           numbers(1);
  std::uniform_real_distribution<double> shift(-3., 3.);
  for (Point<3> &x : cells)
    for (unsigned int d = 0; d < 3; ++d)
      x[d] += shift(numbers);
  const auto patches = surface(cells);
  expect_encloses(patches, cells.size());
  const auto [distance, angle] = departure(patches, radius_of<3>(cells.size()));
  EXPECT_LT(distance, 1.);
  EXPECT_LT(angle, 60.);
}


TEST(PointsSurface, SmallCavityIsFilled)
{
  ONE_RANK_IS_ENOUGH();
  for (const double hole : {1., 2.}) // without 8 or 32 cells
    {
      const auto patches = surface(ball<3>(8., hole));
      bool       is_seen = false;
      for (const Point<3> &x : patches.positions)
        is_seen = is_seen || x.norm() < 70.;
      EXPECT_EQ(is_seen, hole > 1.);
      // What the smoothing leaves of it.
      EXPECT_NEAR(patches.filled, is_seen ? 0. : 4e3, is_seen ? 0. : 3e3);
    }
}


TEST(PointsSurface, ThinAndSmall)
{
  const auto sheet   = lattice<3>(16, [](const Point<3> &x) {
    return std::abs(x[2] - 0.5) < 0.1;
  });
  const auto patches = surface(sheet);
  expect_encloses(patches, sheet.size());
  for (const Point<3> &x : patches.positions)
    if (std::abs(x[0]) < 40. && std::abs(x[1]) < 40.)
      {
        EXPECT_NEAR(std::abs(x[2] - 5.), 5., 1.);
      }
  expect_encloses(surface<3>({Point<3>()}), 1);
  expect_encloses(surface<3>({Point<3>(), Point<3>(10., 0., 0.)}), 2);
  expect_encloses(surface<2>({Point<2>()}), 1);
  expect_encloses(surface<2>({Point<2>(), Point<2>(10., 0.)}), 2);
}


TEST(PointsSurface, WishedNumberOfPatches)
{
  ONE_RANK_IS_ENOUGH();
  // Around the center of a lattice cell numbers would jump by symmetry.
  auto cells = ball<3>(10.);
  for (Point<3> &x : cells)
    x += Point<3>(3., 5., 7.);
  EXPECT_NEAR(surface(cells, 200).n_global, 200, 20);
  EXPECT_NEAR(surface(ball<3>(6.), 3000).n_global, 3000, 300);
  EXPECT_NEAR(surface(ball<2>(10.), 20).n_global, 20, 1);
  EXPECT_NEAR(surface(ball<2>(10.), 500).n_global, 500, 1);
}

TEST(PointsSurface, MatchesVolumesOfCells)
{
  ONE_RANK_IS_ENOUGH();
  // cells that are somewhat smaller than their lattice boxes
  const auto cells   = ball<3>(8.);
  const auto patches = surface(cells, 0, 0.95 * 1e3);
  expect_encloses(patches, 0.95 * cells.size());
}

TEST(PointsSurface, RefusesCellsThatDoNotTouch)
{
  const auto cells = ball<3>(4.);
  for (const double volume : {1., 1e5})
    EXPECT_THROW(surface(cells, 0, volume), InputError) << volume;
  for (const double volume : {1., 1e4})
    EXPECT_THROW(surface(ball<2>(4.), 0, volume), InputError) << volume;
}
