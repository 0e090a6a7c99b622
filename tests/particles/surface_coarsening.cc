// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

template <int dim>
const BoundaryColumns<dim> columns(/*with_patch*/ true, /*coarsens*/ true);

constexpr double longest_edge = 40., radius = 100.;

template <int dim>
bool
nowhere(const Point<dim> &)
{
  return false;
}

/** What makes loads differ: the side on which a point was at t = 0. */
template <int dim>
bool
same_side(const BoundaryView<dim> &a, const BoundaryView<dim> &b)
{
  return (a.seed_position()[0] > 0.) == (b.seed_position()[0] > 0.);
}

/** Equal patches all around, in 3-D on Fibonacci's spiral; one half is held.
 */
template <int dim>
PointList<dim>
round_body()
{
  const unsigned int n = dim == 2 ? 60 : 500;
  PointList<dim>     points(columns<dim>.n_numbers());
  for (unsigned int i = 0; i < n; ++i)
    {
      Tensor<1, dim> N;
      N[dim - 1] = 1. - (2. * i + 1.) / n;
      const double angle =
        dim == 2 ? 2. * numbers::PI * (i + 0.5) / n : 2.399963229728653 * i;
      const double r = dim == 2 ? 1. : std::sqrt(1. - N[2] * N[2]);
      N[0]           = r * std::cos(angle);
      N[1]           = r * std::sin(angle);
      points.add(i,
                 Point<dim>(radius * N),
                 columns<dim>.initial_point(Point<dim>(radius * N),
                                            N,
                                            (dim == 2 ? 2. : 4. * radius) *
                                              numbers::PI * radius / n,
                                            N[1] > 0. ?
                                              SurfaceCondition::fixed :
                                              SurfaceCondition::free));
    }
  return points;
}

/** Scales all by a factor. */
template <int dim>
void
scale(PointList<dim> &points, const double factor)
{
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      points.positions[i] *= factor;
      BoundaryView<dim, double>(points.row(i), columns<dim>)
        .deform(factor * unit_tensor<dim>());
    }
}

/** Merges and splits. @return the next id */
template <int dim>
types::particle_index
renew(PointList<dim> &points, types::particle_index next, const MPI_Comm comm)
{
  coarsen_surface<dim>(
    points, columns<dim>, longest_edge, same_side<dim>, comm);
  refine_surface<dim>(
    points, columns<dim>, longest_edge, nowhere<dim>, next, comm);
  return next;
}

/** To half the radius, in 2-D to a third, and back, in ten steps each. */
template <int dim>
std::vector<double>
radii()
{
  const double        least = dim == 2 ? 1. / 3. : 0.5;
  std::vector<double> list;
  for (int i = 1; i <= 20; ++i)
    list.push_back(std::pow(least, (10 - std::abs(10 - i)) / 10.));
  return list;
}


// A body that shrinks and grows back has between half and twice its patches per
// area at any time, its volume, and its conditions where they were.
TEST_2D_3D(SurfaceCoarsening, KeepsNumberVolumeAndConditions)
{
  PointList<dim>       points = round_body<dim>();
  const PatchSums<dim> start(points, columns<dim>);
  const double         density = points.size() / start.area;
  const std::size_t    n       = points.size();
  std::size_t          fewest  = n;
  auto                 next    = types::particle_index(n);
  double               before  = 1.;
  for (const double r : radii<dim>())
    {
      scale(points, r / before);
      before = r;
      const PatchSums<dim> old(points, columns<dim>);
      next = renew(points, next, MPI_COMM_SELF);
      const PatchSums<dim> sums(points, columns<dim>);
      EXPECT_LT((sums.vector - old.vector).norm(), 1e-12 * old.area);
      EXPECT_NEAR(sums.volume, old.volume, 1e-12 * old.volume);
      EXPECT_NEAR(sums.volume,
                  std::pow(r, dim) * start.volume,
                  1e-11 * start.volume);
      const double found = points.size() / sums.area;
      EXPECT_GT(found, 0.5 * density) << "radius " << r;
      EXPECT_LT(found, 2. * density) << "radius " << r;
      fewest = std::min(fewest, points.size());
      for (std::size_t i = 0; i < points.size(); ++i)
        {
          const BoundaryView<dim> point(points.row(i), columns<dim>);
          // A patch that lies across a border has its middle on either side.
          const Point<dim> x = points.positions[i];
          const bool is_held = point.condition() == SurfaceCondition::fixed;
          EXPECT_TRUE(is_held == (x[1] > 0.) || std::abs(x[1]) < 10.);
          EXPECT_TRUE((point.seed_position()[0] > 0.) == (x[0] > 0.) ||
                      std::abs(x[0]) < 10.);
          EXPECT_LT(std::abs(points.positions[i].norm() / (r * radius) - 1.),
                    0.08);
          EXPECT_LT((point.area_vector() / point.area_vector().norm() -
                     points.positions[i] / points.positions[i].norm())
                      .norm(),
                    0.3);
        }
    }
  EXPECT_LT(fewest, 0.7 * n);
  EXPECT_GT(next, n);
}


// Patches across an edge of the body do not merge, nor do others that are not
// alike.
TEST_2D_3D(SurfaceCoarsening, LeavesApartWhatIsUnlike)
{
  const auto pair = [](const Tensor<1, dim>  &N,
                       const double           at,
                       const SurfaceCondition condition) {
    Tensor<1, dim> up;
    up[dim - 1] = 1.;
    PointList<dim> points(columns<dim>.n_numbers());
    for (const int i : {0, 1})
      {
        Point<dim> X;
        X[0] = i == 0 ? 1. : at;
        points.add(i,
                   X,
                   columns<dim>.initial_point(X,
                                              i == 0 ? up : N,
                                              std::pow(10., dim - 1),
                                              i == 0 ? SurfaceCondition::free :
                                                       condition));
      }
    scale(points, 0.45);
    coarsen_surface<dim>(
      points, columns<dim>, longest_edge, same_side<dim>, MPI_COMM_SELF);
    return points.size();
  };
  Tensor<1, dim> up, aside;
  up[dim - 1] = 1.;
  aside[0]    = 1.;

  EXPECT_EQ(pair(up, 9., SurfaceCondition::free), 1u);
  EXPECT_EQ(pair(aside, 9., SurfaceCondition::free), 2u);
  EXPECT_EQ(pair(up, 9., SurfaceCondition::slip), 2u);
  EXPECT_EQ(pair(up, -7., SurfaceCondition::free), 2u);
  EXPECT_EQ(pair(up, 60., SurfaceCondition::free), 2u); // too far apart
}


// Patches of a slip wall that is squeezed along itself, and that the motion has
// tilted a little: those that they become lie on the same wall, with its
// normal, and the area vectors and the volume stay.
TEST_2D_3D(SurfaceCoarsening, LeavesSlipWallsWhereTheyAre)
{
  Tensor<1, dim> N;
  N[0]                 = -1.;
  const unsigned int n = dim == 2 ? 12 : 36;
  PointList<dim>     points(columns<dim>.n_numbers());
  for (unsigned int i = 0; i < n; ++i)
    {
      Point<dim> X;
      X[0]               = -50.;
      X[1]               = 10. * (i % 12);
      X[dim - 1]         = dim == 2 ? X[1] : 10. * (i / 12);
      const double along = 0.4, tilt = 0.15 * std::sin(7. * i);
      points.add(i,
                 X,
                 columns<dim>.initial_point(
                   X, N, std::pow(10., dim - 1), SurfaceCondition::slip));
      Tensor<2, dim> f = along * unit_tensor<dim>();
      f[0][0]          = 1.1;
      f[0][1] = f[1][0] = tilt;
      BoundaryView<dim, double>(points.row(i), columns<dim>).deform(f);
      points.positions[i] *= along;
      points.positions[i][0] = -50. + std::cos(5. * i);
    }
  const PatchSums<dim> old(points, columns<dim>);
  coarsen_surface<dim>(
    points,
    columns<dim>,
    longest_edge,
    [](const auto &, const auto &) { return true; },
    MPI_COMM_SELF);
  const PatchSums<dim> sums(points, columns<dim>);
  EXPECT_LT(points.size(), 0.7 * n);
  EXPECT_LT((sums.vector - old.vector).norm(), 1e-12 * old.area);
  EXPECT_NEAR(sums.volume, old.volume, 1e-12 * std::abs(old.volume));
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      const BoundaryView<dim> point(points.row(i), columns<dim>);
      EXPECT_NEAR(point.initial_position()[0], -50., 1e-12);
      EXPECT_LT((point.initial_normal() - N).norm(), 1e-14);
      EXPECT_GT(determinant(point.F()), 0.);
    }
}


TEST_2D_3D(SurfaceCoarsening, IsTheSameForAnyNumberOfRanks)
{
  const PointList<dim>  all   = round_body<dim>();
  PointList<dim>        alone = all, mine = dealt(all);
  types::particle_index next_alone = all.size(), next = all.size();
  double                before = 1.;
  for (const double r : radii<dim>())
    {
      scale(alone, r / before);
      scale(mine, r / before);
      before     = r;
      next_alone = renew(alone, next_alone, MPI_COMM_SELF);
      next       = renew(mine, next, MPI_COMM_WORLD);
    }
  EXPECT_EQ(next, next_alone);
  expect_same_points(mine, selected(alone, [&](const std::size_t i) {
                       return std::find(mine.ids.begin(),
                                        mine.ids.end(),
                                        alone.ids[i]) != mine.ids.end();
                     }));
  EXPECT_EQ(sum_over_ranks(mine.size()), alone.size());
}
