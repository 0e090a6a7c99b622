// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

template <int dim>
bool
nowhere(const Point<dim> &)
{
  return false;
}

template <int dim>
const BoundaryColumns<dim> columns(/*with_patch*/ true);

template <int dim>
BoundaryView<dim>
view(const PointList<dim> &points, const std::size_t i)
{
  return {points.row(i), columns<dim>};
}

/** A point with a square patch at x = X, deformed by F. */
template <int dim>
void
add_point(PointList<dim>             &points,
          const types::particle_index id,
          const Point<dim>           &X,
          const Tensor<1, dim>       &N,
          const double                area,
          const Tensor<2, dim>       &F,
          const SurfaceCondition      condition = SurfaceCondition::free)
{
  points.add(id, X, columns<dim>.initial_point(X, N, area, condition));
  BoundaryView<dim, double>(points.row(points.size() - 1), columns<dim>)
    .deform(F);
}

/** Patches of all sizes and directions, strongly deformed. */
template <int dim>
PointList<dim>
random_patches(const unsigned int n)
{
  std::mt19937   generator(3);
  PointList<dim> points(columns<dim>.n_numbers());
  for (unsigned int i = 0; i < n; ++i)
    {
      Tensor<1, dim> N = random_tensor<1, dim>(generator);
      N /= N.norm();
      Tensor<2, dim> F = 4. * unit_tensor<dim>();
      F += 3. * random_tensor<2, dim>(generator);
      add_point<dim>(points,
                     (7 * i + 3) % n,
                     Point<dim>(100. * random_tensor<1, dim>(generator)),
                     N,
                     std::pow(4. + i % 5, dim - 1),
                     F,
                     static_cast<SurfaceCondition>(i % 4));
    }
  return points;
}

template <int dim>
double
linfty(const Tensor<1, dim> &v)
{
  double largest = 0.;
  for (unsigned int d = 0; d < dim; ++d)
    largest = std::max(largest, std::abs(v[d]));
  return largest;
}


TEST_2D_3D(SurfaceRefinement, PatchesAreSquares)
{
  std::mt19937 generator(5);
  for (unsigned int i = 0; i < 30; ++i)
    {
      Tensor<1, dim> N;
      if (i < 2 * dim)
        N[i / 2] = i % 2 ? -1. : 1.;
      else
        N = random_tensor<1, dim>(generator);
      N /= N.norm();
      PointList<dim>   points(columns<dim>.n_numbers());
      const Point<dim> X(7. * random_tensor<1, dim>(generator));
      const double     area = 13.;
      add_point<dim>(points, 0, X, N, area, unit_tensor<dim>());
      const auto point = view(points, 0);
      ASSERT_TRUE(point.has_patch());
      EXPECT_EQ(point.seed_position(), X);
      Tensor<1, dim> span;
      if constexpr (dim == 2)
        span = cross_product_2d(point.initial_edge(0));
      else
        span = cross_product_3d(point.initial_edge(0), point.initial_edge(1));
      EXPECT_NEAR(std::abs(span * N), area, 1e-12);
      EXPECT_NEAR(span.norm(), area, 1e-12);
      EXPECT_NEAR(point.spacing(), std::pow(area, 1. / (dim - 1)), 1e-12);
      for (unsigned int k = 0; k < dim - 1; ++k)
        {
          EXPECT_NEAR(point.initial_edge(k) * N, 0., 1e-14 * area);
          if (i < 2 * dim) // edges along the axes
            {
              EXPECT_NEAR(point.initial_edge(k).norm(),
                          linfty(point.initial_edge(k)),
                          1e-14);
            }
        }
    }
}


// A patch of side 10 stretched by 8 along its edge is four.
TEST_2D_3D(SurfaceRefinement, HalvesAgainAndAgain)
{
  Tensor<1, dim> N;
  N[dim - 1]       = 1.;
  Tensor<2, dim> F = unit_tensor<dim>();
  F[0][0]          = 8.;
  F[dim - 1][0]    = 6.; // shear: the edge now points along (0.8, 0.6)
  PointList<dim> all(columns<dim>.n_numbers());
  add_point<dim>(all, 5, Point<dim>(), N, std::pow(10., dim - 1), F);
  PointList<dim>        points = dealt(all);
  types::particle_index next   = 9;
  EXPECT_TRUE(refine_surface<dim>(
    points, columns<dim>, 25., nowhere<dim>, next, MPI_COMM_WORLD));
  EXPECT_EQ(next, 12u);
  if (this_rank() != 0)
    return;

  ASSERT_EQ(points.size(), 4u);
  // first 5 | 9, then 5 | 10 and 9 | 11
  const std::map<types::particle_index, double> place = {{5, -3.75},
                                                         {10, -1.25},
                                                         {9, 1.25},
                                                         {11, 3.75}};
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      const double   X = place.at(points.ids[i]);
      Tensor<1, dim> expected;
      expected[0] = X;
      EXPECT_LT(
        (view(points, i).initial_position() - Point<dim>(expected)).norm(),
        1e-13);
      EXPECT_LT((points.positions[i] - Point<dim>(F * expected)).norm(), 1e-12);
      EXPECT_EQ(view(points, i).seed_position(), Point<dim>());
      EXPECT_DOUBLE_EQ(view(points, i).initial_area(),
                       0.25 * std::pow(10., dim - 1));
      EXPECT_LT((view(points, i).initial_normal() - N).norm(), 1e-15);
    }
  const auto before = points.ids.size();
  EXPECT_FALSE(refine_surface<dim>(
    points, columns<dim>, 25., nowhere<dim>, next, MPI_COMM_SELF));
  EXPECT_EQ(points.ids.size(), before);
}


// The parts of a patch that is split share the force on it.
TEST_2D_3D(SurfaceRefinement, PartsShareTheForce)
{
  const BoundaryColumns<dim> with_force(true, false, true);
  Tensor<1, dim>             N, force;
  N[dim - 1] = 1.;
  for (unsigned int d = 0; d < dim; ++d)
    force[d] = 4. + d;
  Tensor<2, dim> F = unit_tensor<dim>();
  F[0][0]          = 8.;
  PointList<dim> points(with_force.n_numbers());
  points.add(0,
             Point<dim>(),
             with_force.initial_point(Point<dim>(),
                                      N,
                                      std::pow(10., dim - 1),
                                      SurfaceCondition::loaded));
  const BoundaryView<dim, double> whole(points.row(0), with_force);
  whole.deform(F);
  whole.set(with_force.force, force);
  types::particle_index next = 1;
  EXPECT_TRUE(refine_surface<dim>(
    points, with_force, 25., nowhere<dim>, next, MPI_COMM_SELF));
  ASSERT_EQ(points.size(), 4u);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LT(
      (BoundaryView<dim>(points.row(i), with_force).get(with_force.force) -
       0.25 * force)
        .norm(),
      1e-14);
}


TEST_2D_3D(SurfaceRefinement, ConservesAreaNormalAndMoments)
{
  PointList<dim>        points = random_patches<dim>(60);
  const PatchSums<dim>  before(points, columns<dim>);
  types::particle_index next = 60;
  EXPECT_TRUE(refine_surface<dim>(
    points, columns<dim>, 6., nowhere<dim>, next, MPI_COMM_SELF));
  EXPECT_EQ(points.size(), next);
  EXPECT_GT(points.size(), 200u);
  const PatchSums<dim> after(points, columns<dim>);
  EXPECT_NEAR(after.initial_area, before.initial_area, 1e-10);
  EXPECT_NEAR(after.conditions, before.conditions, 1e-10);
  EXPECT_NEAR(after.volume / before.volume, 1., 1e-11);
  EXPECT_LT((after.initial_vector - before.initial_vector).norm(), 1e-10);
  EXPECT_LT((after.vector - before.vector).norm(), 1e-9);
  // Halves that are bent are a little longer than flat ones.
  EXPECT_LT((after.moment - before.moment).norm() / before.moment.norm(), 1e-2);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (unsigned int k = 0; k < dim - 1; ++k)
      EXPECT_LE((view(points, i).F() * view(points, i).initial_edge(k)).norm(),
                6.);
}


// Parts of a circle's patches lie on one, with its normals; those of a box at
// whose corners patches meet stay where they are.
TEST(SurfaceRefinement, PartsAreCurvedAsTheSurface)
{
  constexpr unsigned int n = 24;
  constexpr double       R = 50., length = 2. * numbers::PI * R / n;
  PointList<2>           circle(columns<2>.n_numbers());
  for (unsigned int i = 0; i < n; ++i)
    {
      const double       angle = 2. * numbers::PI * i / n;
      const Tensor<1, 2> N({std::cos(angle), std::sin(angle)});
      add_point<2>(circle, i, Point<2>(R * N), N, length, unit_tensor<2>());
    }
  PointList<2>          points = dealt(circle);
  types::particle_index next   = n;
  refine_surface<2>(
    points, columns<2>, 0.3 * length, nowhere<2>, next, MPI_COMM_WORLD);
  EXPECT_EQ(next, 4 * n);
  const double sagitta = length * length / (8. * R);
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      const Tensor<1, 2> x(points.positions[i]),
        area = view(points, i).area_vector();
      EXPECT_NEAR(x.norm(), R - 5. / 16. * sagitta, 0.01 * sagitta);
      EXPECT_GT(area * x, (1. - 1e-6) * area.norm() * x.norm());
    }

  PointList<2> box(columns<2>.n_numbers());
  for (unsigned int i = 0; i < 4; ++i)
    {
      Tensor<1, 2> N;
      N[i / 2] = i % 2 ? 1. : -1.;
      add_point<2>(box, i, Point<2>(5. * N), N, 10., unit_tensor<2>());
    }
  next = 4;
  refine_surface<2>(box, columns<2>, 6., nowhere<2>, next, MPI_COMM_SELF);
  EXPECT_EQ(box.size(), 8u);
  for (const Point<2> &x : box.positions)
    EXPECT_EQ(linfty<2>(x), 5.);
}


TEST_2D_3D(SurfaceRefinement, LeavesCrowds)
{
  const PointList<dim>  all     = random_patches<dim>(60);
  PointList<dim>        points  = all;
  const auto            crowded = [](const Point<dim> &x) { return x[0] > 0.; };
  types::particle_index next    = 60;
  EXPECT_TRUE(refine_surface<dim>(
    points, columns<dim>, 6., crowded, next, MPI_COMM_SELF));
  unsigned int n_crowded = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (crowded(all.positions[i]))
      {
        ++n_crowded;
        EXPECT_EQ(points.ids[i], all.ids[i]);
        EXPECT_EQ(points.positions[i], all.positions[i]);
        EXPECT_EQ(view(points, i).initial_area(), view(all, i).initial_area());
      }
  EXPECT_GT(n_crowded, 10u);
  // All others are split as if they were alone.
  PointList<dim> others = selected(all, [&](const std::size_t i) {
    return !crowded(all.positions[i]);
  });
  next                  = 60;
  refine_surface<dim>(
    others, columns<dim>, 6., nowhere<dim>, next, MPI_COMM_SELF);
  EXPECT_EQ(points.size(), others.size() + n_crowded);
}


// The circle that spacing() stands for reaches over the whole patch.
TEST_2D_3D(SurfaceRefinement, SpacingCoversThePatch)
{
  const PointList<dim> points = random_patches<dim>(60);
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      const auto point = view(points, i);
      for (unsigned int corner = 0; corner < (1u << (dim - 1)); ++corner)
        {
          Tensor<1, dim> to_corner;
          for (unsigned int k = 0; k < dim - 1; ++k)
            to_corner += ((corner >> k) & 1 ? 0.5 : -0.5) *
                         (point.F() * point.initial_edge(k));
          EXPECT_LE(to_corner.norm(), point.spacing() * (1. + 1e-12));
        }
    }
}


// A tissue takes points in place of others, also beyond its grid.
TEST_2D_3D(SurfaceRefinement, TissueTakesTheNewPoints)
{
  Tissue<dim>          tissue(GridParameters(),
                     CellColumns<dim>(),
                     MPI_COMM_WORLD,
                     columns<dim>);
  const PointList<dim> all = random_patches<dim>(60);
  tissue.place(PointList<dim>(), dealt(all));

  PointList<dim>        alone = all, mine = tissue.boundary_points().copy();
  types::particle_index next_alone = 60, next = 60;
  refine_surface<dim>(
    alone, columns<dim>, 6., nowhere<dim>, next_alone, MPI_COMM_SELF);
  refine_surface<dim>(
    mine, columns<dim>, 6., nowhere<dim>, next, MPI_COMM_WORLD);
  tissue.replace_surface(mine);
  expect_same_points(tissue.boundary_points().copy(),
                     owned(alone, tissue.grid()));

  for (auto *list : {&alone, &mine})
    for (Point<dim> &x : list->positions)
      x[0] += 5000.;
  tissue.replace_surface(mine);
  expect_same_points(tissue.boundary_points().copy(),
                     owned(alone, tissue.grid()));
}
