// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "seeding/room.h"

const double pi = numbers::PI;

/** All ranks' patches in id order; checks ids, shares and unit normals. */
template <int dim>
SurfacePatches<dim>
seed_and_gather(const TissueParameters &parameters)
{
  parameters.check(dim);
  const auto mine = seed_surface<dim>(parameters, MPI_COMM_WORLD);
  EXPECT_EQ(mine.normals.size(), mine.positions.size());
  EXPECT_EQ(mine.areas.size(), mine.positions.size());

  SurfacePatches<dim> all;
  const auto          append = [](auto &to, const auto &mine) {
    for (const auto &piece : Utilities::MPI::all_gather(MPI_COMM_WORLD, mine))
      to.insert(to.end(), piece.begin(), piece.end());
  };
  append(all.positions, mine.positions);
  append(all.normals, mine.normals);
  append(all.areas, mine.areas);
  all.n_global = mine.n_global;
  EXPECT_EQ(all.positions.size(), mine.n_global);
  for (const Tensor<1, dim> &normal : all.normals)
    EXPECT_NEAR(normal.norm(), 1., 1e-14);

  // a contiguous piece of about equal size
  const double share = static_cast<double>(mine.n_global) / number_of_ranks();
  EXPECT_NEAR(mine.positions.size(), share, 1.);
  for (std::size_t i = 0; i < mine.positions.size(); ++i)
    EXPECT_EQ(mine.positions[i], all.positions.at(mine.first_id + i));
  return all;
}

/** Smallest distance between two patches in units of sqrt(mean area). */
double
smallest_gap(const SurfacePatches<3> &patches)
{
  double gap = 1e300;
  for (std::size_t i = 0; i < patches.positions.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      gap = std::min(gap, patches.positions[i].distance(patches.positions[j]));
  return gap / std::sqrt(Sums(patches).area / patches.areas.size());
}

/** The perimeter of an ellipse by its trapezoidal sum (spectral). */
double
ellipse_perimeter(const double a, const double b)
{
  const int n   = 2000;
  double    sum = 0.;
  for (int i = 0; i < n; ++i)
    sum +=
      std::hypot(a * std::sin(2. * pi * i / n), b * std::cos(2. * pi * i / n));
  return 2. * pi * sum / n;
}

TissueParameters
box(const std::vector<double> &size, const unsigned int n)
{
  TissueParameters parameters;
  parameters.shape           = "box";
  parameters.size            = size;
  parameters.boundary_points = n;
  return parameters;
}

TissueParameters
ellipsoid(const std::vector<double> &size, const unsigned int n)
{
  TissueParameters parameters = box(size, n);
  parameters.shape            = "ellipsoid";
  return parameters;
}

TEST(SurfacePatches, SphereOfThePaper)
{
  TissueParameters parameters;
  parameters.boundary_points = 2600;
  parameters.center          = {10., -20., 30.};
  const auto patches         = seed_and_gather<3>(parameters);
  ASSERT_EQ(patches.n_global, 2600u);
  EXPECT_NEAR(Sums(patches).area / (4. * pi * 250. * 250.), 1., 1e-12);
  EXPECT_LT(Sums(patches).openness(), 1e-4);
  EXPECT_NEAR(Sums(patches).volume / (4. / 3. * pi * std::pow(250., 3)),
              1.,
              1e-4);
  EXPECT_GT(smallest_gap(patches), 0.7);
  const Point<3> center(10., -20., 30.);
  for (unsigned int i = 0; i < 2600; ++i)
    {
      const Tensor<1, 3> arm = patches.positions[i] - center;
      ASSERT_NEAR(arm[2], 250. * (1. - (2. * i + 1.) / 2600.), 1e-9);
      ASSERT_LT((arm - 250. * patches.normals[i]).norm(), 1e-9);
      ASSERT_DOUBLE_EQ(patches.areas[i], patches.areas[0]);
    }
  // turned by the golden angle
  const Tensor<1, 3> a = patches.positions[1000] - center;
  const Tensor<1, 3> b = patches.positions[1001] - center;
  EXPECT_NEAR((a[0] * b[0] + a[1] * b[1]) /
                (std::hypot(a[0], a[1]) * std::hypot(b[0], b[1])),
              std::cos(pi * (3. - std::sqrt(5.))),
              1e-9);
}

TEST(SurfacePatches, OnePerSpacingSquaredByDefault)
{
  TissueParameters parameters;
  EXPECT_EQ(seed_and_gather<3>(parameters).n_global, 7854u);
  parameters.shape = "box";
  EXPECT_EQ(seed_and_gather<3>(parameters).n_global, 2400u);
  parameters.shape = "sphere";
  EXPECT_EQ(seed_and_gather<2>(parameters).n_global, 157u);
}

TEST(SurfacePatches, CubeOfThePaper)
{
  TissueParameters parameters = box({200., 200., 200.}, 2904);
  parameters.center           = {0., 0., 100.};
  const auto patches          = seed_and_gather<3>(parameters);
  ASSERT_EQ(patches.n_global, 6u * 22u * 22u);
  EXPECT_NEAR(Sums(patches).area / 240000., 1., 1e-12);
  EXPECT_LT(Sums(patches).openness(), 1e-14);
  EXPECT_NEAR(Sums(patches).volume / 8e6, 1., 1e-12);
  std::size_t on_bottom = 0;
  for (std::size_t i = 0; i < patches.positions.size(); ++i)
    {
      unsigned int n_on_faces = 0;
      for (unsigned int d = 0; d < 3; ++d)
        {
          const double x = patches.positions[i][d] - (d == 2 ? 100. : 0.);
          if (std::abs(std::abs(x) - 100.) < 1e-12)
            {
              ++n_on_faces;
              ASSERT_EQ(patches.normals[i][d], x > 0. ? 1. : -1.);
            }
          else
            {
              // middles of patches, 100/22 from the edge or more
              ASSERT_LT(std::abs(x), 100. - 100. / 22. + 1e-9);
            }
        }
      ASSERT_EQ(n_on_faces, 1u);
      on_bottom += patches.positions[i][2] == 0. ? 1 : 0;
    }
  EXPECT_EQ(on_bottom, 22u * 22u);
}

TEST(SurfacePatches, BoxesMeetTheWishedNumberNearly)
{
  for (const unsigned int n : {1u, 6u, 50u, 51u, 600u, 2600u, 20000u})
    for (const std::vector<double> &size :
         {std::vector<double>{200., 200., 200.},
          {300., 10., 50.},
          {1., 1., 9.}})
      {
        TissueParameters parameters = box(size, n);
        parameters.cell_spacing     = 0.5;
        const auto   patches = seed_surface<3>(parameters, MPI_COMM_SELF);
        const double area =
          2. * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0]);
        EXPECT_NEAR(Sums(patches).area / area, 1., 1e-12);
        EXPECT_NEAR(Sums(patches).volume / (size[0] * size[1] * size[2]),
                    1.,
                    1e-12);
        EXPECT_LT(Sums(patches).openness(), 1e-14);
        if (n >= 600)
          {
            EXPECT_NEAR(patches.areas.size(), n, 0.06 * n);
          }
      }
  // the fewest: one on each face
  EXPECT_EQ(seed_and_gather<3>(box({200., 200., 200.}, 1)).n_global, 6u);
}

TEST(SurfacePatches, Ellipsoids)
{
  // spheroids in closed form, with the polar axis anywhere
  const double a = 60., c = 20.;
  const double e = std::sqrt(1. - c * c / (a * a));
  const double oblate =
    2. * pi * a * a * (1. + (1. - e * e) / e * std::atanh(e));
  const double prolate = 2. * pi * c * c * (1. + a / (c * e) * std::asin(e));
  for (unsigned int axis = 0; axis < 3; ++axis)
    {
      std::vector<double> size(3, 2. * a);
      size[axis] = 2. * c;
      EXPECT_NEAR(Sums(seed_and_gather<3>(ellipsoid(size, 1000))).area / oblate,
                  1.,
                  1e-12);
      size.assign(3, 2. * c);
      size[axis] = 2. * a;
      EXPECT_NEAR(Sums(seed_and_gather<3>(ellipsoid(size, 1000))).area /
                    prolate,
                  1.,
                  1e-12);
    }
}

TEST(SurfacePatches, EllipsoidsAreEvenlyCovered)
{
  for (const std::vector<double> &size : {std::vector<double>{100., 160., 60.},
                                          {50., 60., 300.},
                                          {200., 30., 160.},
                                          {80., 80., 81.}})
    {
      const auto patches = seed_and_gather<3>(ellipsoid(size, 3000));
      ASSERT_EQ(patches.n_global, 3000u);
      EXPECT_LT(Sums(patches).openness(), 2e-4);
      EXPECT_NEAR(Sums(patches).volume /
                    (pi / 6. * size[0] * size[1] * size[2]),
                  1.,
                  2e-3);
      EXPECT_GT(smallest_gap(patches), 0.4);
      for (std::size_t i = 0; i < 3000; ++i)
        {
          double         level = 0.;
          Tensor<1, 3>   gradient;
          const Point<3> x = patches.positions[i];
          for (unsigned int d = 0; d < 3; ++d)
            {
              level += std::pow(2. * x[d] / size[d], 2);
              gradient[d] = x[d] / (size[d] * size[d]);
            }
          ASSERT_NEAR(level, 1., 1e-12);
          ASSERT_LT((gradient / gradient.norm() - patches.normals[i]).norm(),
                    1e-12);
        }
    }
}

// Both surfaces have their areas, and enclose what lies between.
TEST_2D_3D(SurfacePatches, Shell)
{
  TissueParameters parameters;
  parameters.shape           = "sphere";
  parameters.center          = {7., 8., 9.};
  parameters.radius          = 100.;
  parameters.inner_radius    = 60.;
  parameters.boundary_points = 3000;
  const auto       patches   = seed_and_gather<dim>(parameters);
  const Point<dim> center    = leading_components<dim>(parameters.center);
  double           inner     = 0.;
  for (std::size_t i = 0; i < patches.areas.size(); ++i)
    {
      const Tensor<1, dim> arm = patches.positions[i] - center;
      const bool           out = arm * patches.normals[i] > 0.;
      EXPECT_NEAR(arm.norm(), out ? 100. : 60., 1e-10);
      EXPECT_NEAR(arm * patches.normals[i], out ? 100. : -60., 1e-10);
      inner += out ? 0. : patches.areas[i];
    }
  const double unit = dim == 3 ? 4. * pi : 2. * pi;
  EXPECT_NEAR(inner, unit * std::pow(60., dim - 1), 1e-8);
  EXPECT_NEAR(Sums(patches).area - inner, unit * std::pow(100., dim - 1), 1e-8);
  EXPECT_LE(Sums(patches).openness(), 1e-3);
  EXPECT_NEAR(Sums(patches).volume,
              unit / dim * (std::pow(100., dim) - std::pow(60., dim)),
              1e-3 * std::pow(100., dim));
  EXPECT_NEAR(patches.areas.front() / patches.areas.back(), 1., 0.01);
  EXPECT_EQ(patches.n_global, 3000u);
}



TEST(SurfacePatches, Cylinders)
{
  TissueParameters parameters;
  parameters.shape  = "cylinder";
  parameters.radius = 40.;
  parameters.center = {1., 2., 3.};
  for (const double height : {20., 100., 700.})
    {
      parameters.size            = {0., 0., height};
      parameters.boundary_points = 2000;
      const auto patches         = seed_and_gather<3>(parameters);
      ASSERT_EQ(patches.n_global, 2000u);
      const double side = 80. * pi * height, cap = 1600. * pi;
      EXPECT_NEAR(Sums(patches).area / (side + 2. * cap), 1., 1e-12);
      EXPECT_LT(Sums(patches).openness(), 1e-14);
      EXPECT_NEAR(Sums(patches).volume / (cap * height), 1., 1e-12);
      EXPECT_GT(smallest_gap(patches), 0.6);
      const double patch = std::sqrt((side + 2. * cap) / 2000.);
      double       top   = 0.;
      for (std::size_t i = 0; i < 2000; ++i)
        {
          const Tensor<1, 3> arm = patches.positions[i] - Point<3>(1., 2., 3.);
          const double       r   = std::hypot(arm[0], arm[1]);
          const bool         on_cap = patches.normals[i][2] != 0.;
          ASSERT_NEAR(on_cap ? std::abs(arm[2]) : r,
                      on_cap ? 0.5 * height : 40.,
                      1e-11);
          ASSERT_LT(on_cap ? r : std::abs(arm[2]),
                    (on_cap ? 40. : 0.5 * height) - 0.4 * patch);
          top += patches.normals[i][2] > 0. ? patches.areas[i] : 0.;
        }
      EXPECT_NEAR(top / cap, 1., 1e-12);
    }
}


TEST(SurfacePatches, Rectangle)
{
  TissueParameters parameters = box({30., 50.}, 32);
  parameters.center           = {15., 0.};
  const auto patches          = seed_and_gather<2>(parameters);
  ASSERT_EQ(patches.n_global, 32u);
  EXPECT_NEAR(Sums(patches).area, 160., 1e-10);
  EXPECT_LT(Sums(patches).openness(), 1e-14);
  EXPECT_NEAR(Sums(patches).volume, 1500., 1e-9);
  std::set<double> heights; // on the left side
  for (std::size_t i = 0; i < 32; ++i)
    if (patches.normals[i] * Point<2>(-1., 0.) == 1.)
      {
        EXPECT_EQ(patches.positions[i][0], 0.);
        heights.insert(patches.positions[i][1]);
      }
  EXPECT_EQ(heights.size(), 10u);
  EXPECT_NEAR(*heights.begin(), -22.5, 1e-12);
}

TEST(SurfacePatches, Ellipse)
{
  for (const std::vector<double> &size :
       {std::vector<double>{60., 40.}, {40., 60.}, {50., 50.}, {100., 20.}})
    {
      const unsigned int n       = 400;
      const auto         patches = seed_and_gather<2>(ellipsoid(size, n));
      ASSERT_EQ(patches.n_global, n);
      const double perimeter = ellipse_perimeter(0.5 * size[0], 0.5 * size[1]);
      EXPECT_NEAR(Sums(patches).area / perimeter, 1., 1e-12);
      EXPECT_LT(Sums(patches).openness(), 1e-12);
      EXPECT_NEAR(Sums(patches).volume / (0.25 * pi * size[0] * size[1]),
                  1.,
                  2e-3);
      for (unsigned int i = 0; i < n; ++i)
        {
          // equal arcs: chords differ from them by the curvature only
          ASSERT_NEAR(patches.positions[i].distance(
                        patches.positions[(i + 1) % n]),
                      perimeter / n,
                      0.02 * perimeter / n);
          ASSERT_NEAR(std::pow(2. * patches.positions[i][0] / size[0], 2) +
                        std::pow(2. * patches.positions[i][1] / size[1], 2),
                      1.,
                      1e-12);
        }
    }
}

TEST(SurfacePatches, FewAreStillClosed)
{
  for (const std::string shape : {"sphere", "box", "ellipsoid", "cylinder"})
    for (unsigned int n = 1; n < 30; ++n)
      {
        TissueParameters parameters;
        parameters.shape           = shape;
        parameters.boundary_points = n;
        const auto patches         = seed_and_gather<3>(parameters);
        EXPECT_GE(patches.n_global, 4u);
        EXPECT_LT(Sums(patches).openness(), 0.2) << shape << ' ' << n;
        for (const Tensor<1, 3> &normal : patches.normals)
          ASSERT_TRUE(std::isfinite(normal.norm()));
        if (shape != "cylinder")
          {
            const auto in_plane = seed_and_gather<2>(parameters);
            EXPECT_GE(in_plane.n_global, 3u);
            EXPECT_LT(Sums(in_plane).openness(), 1e-12) << shape << ' ' << n;
          }
      }
}
