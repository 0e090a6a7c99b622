// ranks: 1 2 4
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "surface/room.h"

const auto comm = MPI_COMM_WORLD;

/** The surface around all cells, whose volume it encloses, and which is closed.
 */
template <int dim>
CellSurface<dim>
surface_of(const PointList<dim>  &cells,
           const double           h,
           const Point<dim>      &offset = Point<dim>(),
           const CellSurfaceWish &wish   = CellSurfaceWish())
{
  const auto surface =
    surface_of_all_cells<dim>(cells, GridBox<dim>({}, {}, h, offset), wish);
  double         volume = 0., area = 0.;
  Tensor<1, dim> sum;
  for (std::size_t k = 0; k < surface.areas.size(); ++k)
    {
      volume +=
        (surface.positions[k] - surface.positions[0]) * surface.areas[k] / dim;
      area += surface.areas[k].norm();
      sum += surface.areas[k];
    }
  EXPECT_LT(sum.norm(), 1e-8 * area);
  EXPECT_NEAR(surface.volume / (wish.share * total_volume(cells)), 1., 1e-5);
  EXPECT_NEAR(volume / surface.volume, 1., 1e-6);
  EXPECT_NEAR(area / surface.area, 1., 1e-6);
  return surface;
}

/** The rate at which a patch grows in a stretch along x, negative. */
template <int dim>
double
tension(const Tensor<1, dim> &A)
{
  return (A.norm_square() / (dim - 1) - A[0] * A[0] * dim / (dim - 1.)) /
         A.norm();
}

template <int dim>
double
tension(const CellSurface<dim> &surface)
{
  double sum = 0.;
  for (const Tensor<1, dim> &A : surface.areas)
    sum += tension(A);
  return sum;
}

/** The tension of the surface that a closed curve makes when it turns about the
 *  x axis. */
struct Revolved
{
  /** @param curve (x, r) by t in [0, 1], rising x first */
  explicit Revolved(const std::function<Point<2>(double)> &curve)
  {
    constexpr unsigned int n = 10000;
    for (unsigned int i = 0; i < n; ++i)
      {
        const Point<2>     a = curve(1. * i / n), b = curve((i + 1.) / n);
        const Tensor<1, 2> way    = b - a;
        const double       r      = 0.5 * (a[1] + b[1]);
        const double       length = way.norm();
        // tension() of area vectors all around
        if (length > 0.)
          tension += 2. * numbers::PI * r *
                     (0.5 * length - 1.5 * way[1] * way[1] / length);
      }
  }

  double tension = 0.;
};


// Second order in the length of the cells.
TEST(CellSurface, BallIsRound)
{
  ONE_RANK_IS_ENOUGH();
  const auto error = [](const double l) {
    const auto cells =
      trimmed<3>(l, 105., [](const auto &x) { return x.norm() < 100.; });
    const auto surface = surface_of(cells, 3. * l);
    EXPECT_EQ(surface.n_parts, 1u);
    double square = 0.; // of the error of the normal
    for (std::size_t k = 0; k < surface.areas.size(); ++k)
      {
        const Tensor<1, 3> A = surface.areas[k], x = surface.positions[k];
        square += A.norm() * (A / A.norm() - x / x.norm()).norm_square();
      }
    EXPECT_LT(std::sqrt(square / surface.area), 1.2 * numbers::PI / 180.);
    const double V = total_volume(cells);
    return surface.area / std::cbrt(36. * numbers::PI * V * V) - 1.;
  };
  const double coarse = error(14.), fine = error(7.);
  EXPECT_LT(std::abs(coarse), 0.0025);
  EXPECT_LT(std::abs(fine), 0.0006);
  EXPECT_NEAR(coarse / fine, 4., 0.7);
}


// Wherever the lattice lies.
TEST(CellSurface, TurnsAndMovesWithTheCells)
{
  ONE_RANK_IS_ENOUGH();
  std::mt19937 random(1);
  const auto   cells =
    trimmed<3>(14., 105., [](const auto &x) { return x.norm() < 100.; });
  for (unsigned int i = 0; i < 6; ++i)
    {
      PointList<3>       turned = cells;
      const Tensor<1, 3> shift  = 50. * random_tensor<1, 3>(random);
      Tensor<2, 3>       swap;
      swap[0][1] = swap[1][2] = swap[2][0] = 1.;
      const Tensor<2, 3> Q = rotation<3>(i) * swap * rotation<3>(0.3 * i);
      for (Point<3> &x : turned.positions)
        x = Point<3>(Q * x + shift);
      const auto   surface = surface_of(turned, 42.);
      const double V       = total_volume(cells);
      EXPECT_NEAR(surface.area / std::cbrt(36. * numbers::PI * V * V),
                  1.,
                  0.003);
      EXPECT_EQ(surface.n_parts, 1u);
    }
}


/** The error of the tension of a body of revolution. */
template <typename Inside>
double
error_of_tension(const Revolved &exact, const double l, const Inside &inside)
{
  const auto cells = trimmed<3>(l, 165., [&](const Point<3> &x) {
    return inside(x[0], std::hypot(x[1], x[2]));
  });
  return tension(surface_of(cells, 3. * l)) / exact.tension - 1.;
}

// As surface tension works. Four times better per halving.
TEST(CellSurface, EllipsoidHasItsTension)
{
  ONE_RANK_IS_ENOUGH();
  const Revolved exact([](const double t) {
    return Point<2>(-160. * std::cos(numbers::PI * t),
                    80. * std::sin(numbers::PI * t));
  });
  const auto     error = [&](const double l) {
    return error_of_tension(exact, l, [](const double x, const double r) {
      return std::hypot(x / 160., r / 80.) < 1.;
    });
  };
  const double fine = error(7.);
  EXPECT_LT(std::abs(fine), 0.01);
  EXPECT_NEAR(error(14.) / fine, 4., 0.4);
}

TEST(CellSurface, TorusHasItsTension)
{
  ONE_RANK_IS_ENOUGH();
  const Revolved exact([](const double t) {
    return Point<2>(-45. * std::cos(2. * numbers::PI * t),
                    100. + 45. * std::sin(2. * numbers::PI * t));
  });
  const auto     error = [&](const double l) {
    return error_of_tension(exact, l, [](const double x, const double r) {
      return std::hypot(x, r - 100.) < 45.;
    });
  };
  const double fine = error(7.);
  EXPECT_LT(std::abs(fine), 0.01);
  EXPECT_NEAR(error(14.) / fine, 4., 0.4);
}


// A neck three cells wide.
TEST(CellSurface, NeckPullsAlmostAsItShould)
{
  ONE_RANK_IS_ENOUGH();
  const double   R = 50., c = 65., r = 10.5, neck = std::asin(r / R);
  const Revolved exact([&](const double t) {
    const double q    = std::min(t, 1. - t);
    const double side = t < 0.5 ? -1. : 1.;
    const double turn = std::min(1., q / 0.45) * (numbers::PI - neck);
    return q < 0.45 ?
             Point<2>(side * (c + R * std::cos(turn)), R * std::sin(turn)) :
             Point<2>(side * (c - R * std::cos(neck)) * (0.5 - q) / 0.05, r);
  });
  EXPECT_LT(std::abs(error_of_tension(exact,
                                      7.,
                                      [&](const double x, const double q) {
                                        return (q < r && std::abs(x) < c) ||
                                               std::hypot(std::abs(x) - c, q) <
                                                 R;
                                      })),
            0.5);
}


// Gaps of 1.25 lengths of a cell and more are seen.
TEST(CellSurface, TwoBallsAreTwo)
{
  ONE_RANK_IS_ENOUGH();
  const double l = 10., R = 60.;
  for (const double gap : {2., 1.5, 1.25, 0.5})
    {
      const double c     = R + 0.5 * gap * l;
      const auto   cells = trimmed<3>(l, 145., [&](Point<3> x) {
        x[0] = std::abs(x[0]) - c;
        return x.norm() < R;
      });
      EXPECT_EQ(surface_of(cells, 3. * l, Point<3>(3., 1., 2.)).n_parts,
                gap > 1. ? 2u : 1u)
        << gap;
    }
}


/** The cavities, two of the radius R with a septum between, or one in the
 *  middle, in a larger ball: their mean volume is that of R to the tolerance.
 */
template <int dim>
void
expect_cavities(const double R,
                const double l,
                const double septum,
                const double tolerance)
{
  const bool   is_single = septum == 0.;
  const double c         = is_single ? 0. : R + 0.5 * septum;
  const double outer     = R + c + 5. * l;
  const auto   cells     = trimmed<dim>(l, outer + l, [&](Point<dim> x) {
    x[0] -= 0.5 * l;
    const bool is_inside = x.norm() < outer;
    x[0]                 = std::abs(x[0]) - c;
    return is_inside && x.norm() > R;
  });
  const auto   surface   = surface_of(cells, 2. * l);
  ASSERT_EQ(surface.cavities.size(), is_single ? 1u : 2u) << septum;
  EXPECT_EQ(surface.n_parts, 1u);
  const double exact =
    (dim == 2 ? numbers::PI : 4. / 3. * numbers::PI) * std::pow(R, dim);
  for (const double volume : surface.cavities)
    EXPECT_NEAR(volume / exact, 1., tolerance) << septum;
  // Patches know which of them they face.
  std::vector<std::set<bool>> sides(surface.cavities.size() + 1);
  for (std::size_t k = 0; k < surface.positions.size(); ++k)
    {
      Point<dim> x = surface.positions[k];
      x[0] -= 0.5 * l;
      EXPECT_EQ(surface.faced[k] == 0, x.norm() > outer - 2. * l);
      sides.at(surface.faced[k]).insert(x[0] > 0.);
    }
  for (std::size_t k = 1; k < sides.size(); ++k)
    EXPECT_EQ(sides[k].size(), is_single ? 2u : 1u);
}

// The bias of the smoothing is s^2/R of the radius in 3-D, half of it in 2-D.
TEST(CellSurface, ShellHasACavity)
{
  ONE_RANK_IS_ENOUGH();
  expect_cavities<2>(50., 5., 0., 0.01);
  expect_cavities<3>(50., 5., 0., 0.015);
}

// Down to one cell.
TEST(CellSurface, SeptumPartsCavities)
{
  ONE_RANK_IS_ENOUGH();
  for (const double septum : {6., 3., 2., 1.5, 1.})
    expect_cavities<2>(50., 5., 5. * septum, 0.01);
  expect_cavities<3>(40., 8., 8., 0.05);
}


// Holes with less room than is wished are filled, larger ones stay.
TEST_2D_3D(CellSurface, FillsSmallHoles)
{
  ONE_RANK_IS_ENOUGH();
  const double l = 10.;
  const auto   cells =
    cells_at(lattice_points<dim>(Point<dim>(),
                                 80.,
                                 l,
                                 [](const auto &x) {
                                   return x.norm() < 80. && x.norm() > 18.;
                                 }),
             l);
  for (const double gap : {2., 5.})
    {
      CellSurfaceWish wish;
      wish.gap           = gap;
      wish.share         = 0.98;
      const auto surface = surface_of(cells, 2. * l, Point<dim>(), wish);
      EXPECT_EQ(surface.cavities.size(), gap < 3. ? 1u : 0u);
    }
}


// Few cells have a surface, on any grid.
TEST_2D_3D(CellSurface, EnclosesFewCells)
{
  ONE_RANK_IS_ENOUGH();
  const double         l      = 10.;
  const Point<dim>     offset = Point<dim>(3.7 * Point<dim>::unit_vector(0));
  const Tensor<1, dim> step   = l * Point<dim>::unit_vector(0);
  const Point<dim>     origin, next(step), far(20. * step);
  const auto           cube = lattice_points<dim>(l, l);
  for (const double h : {10., 20., 30., 200.})
    {
      const auto n_parts = [&](const std::vector<Point<dim>> &cells) {
        return surface_of(cells_at(cells, l), h, offset).n_parts;
      };
      EXPECT_EQ(n_parts({origin}), 1u);
      EXPECT_EQ(n_parts({origin, next}), 1u);
      EXPECT_EQ(n_parts({origin, far}), 2u);
      EXPECT_EQ(n_parts(cube), 1u);
      auto cells   = cube;
      cells.back() = far;
      // In 3-D, one cell far from others is smoothed to less than the level.
      EXPECT_EQ(n_parts(cells), dim == 2 ? 2u : 1u) << h;
    }
  EXPECT_EQ(surface_of_all_cells<dim>(PointList<dim>(1), GridBox<dim>())
              .positions.size(),
            0u);
}


/** Cells strewn in a shell, with a part far away. */
template <int dim>
PointList<dim>
strewn()
{
  std::mt19937                           random(7);
  std::uniform_real_distribution<double> uniform(-1., 1.);
  PointList<dim>                         cells(1);
  while (cells.size() < (dim == 2 ? 500 : 3000))
    {
      Point<dim> x = Point<dim>(100. * random_tensor<1, dim>(random));
      if (x.norm() > 100. || x.norm() < 45.)
        continue;
      if (cells.size() % 100 == 0)
        x[0] += 300.;
      add_cell(x,
               (1. + 0.5 * uniform(random)) * (dim == 2 ? 60. : 1200.),
               cells);
    }
  return cells;
}

// Cells lie where ranks do not own their grid cells, too.
TEST_2D_3D(CellSurface, IsEqualToTheBitOnAnyNumberOfRanks)
{
  for (const double h : {dim == 2 ? 15. : 20., 40., 500.})
    {
      GridParameters parameters  = grid_of_spacing(h);
      parameters.offset          = std::vector<double>{1., 2., -3.};
      const PointList<dim> cells = strewn<dim>();
      BackgroundGrid<dim>  grid(parameters, comm);
      const auto [first, last] = extent<dim>({&cells.positions}, grid);
      grid.enclose(first, last);
      GridCellCounts weights;
      if (this_rank() == 0)
        for (const Point<dim> &x : cells.positions)
          weights.push_back({grid.box().number(grid.box().locate(x)), 1});
      grid.partition(weights);
      PointList<dim> own(1);
      for (std::size_t i = 0; i < cells.size(); ++i)
        if ((i % 20 == 0 ?
               i / 20 % number_of_ranks() :
               grid.owner(grid.locate(cells.positions[i]))) == this_rank())
          own.add(i, cells.positions[i], cells.row(i));

      const auto all     = surface_of_all_cells(cells, grid.box());
      const auto surface = surface_of_cells(own, grid);
      EXPECT_EQ(surface.n_patches, all.n_patches);
      EXPECT_EQ(surface.n_parts, all.n_parts);
      EXPECT_EQ(surface.cavities, all.cavities);
      EXPECT_EQ(surface.volume, all.volume);
      EXPECT_EQ(surface.area, all.area);
      EXPECT_EQ(surface.offset, all.offset);
      EXPECT_EQ(sum_over_ranks<std::uint64_t>(surface.places.size()),
                all.n_patches);
      ASSERT_EQ(all.places.size(), all.n_patches);
      std::vector<std::size_t> at(all.n_patches, all.n_patches);
      for (std::size_t k = 0; k < all.n_patches; ++k)
        at.at(all.places[k]) = k;
      for (std::size_t k = 0; k < surface.places.size(); ++k)
        {
          const std::size_t other = at.at(surface.places[k]);
          ASSERT_LT(other, all.n_patches);
          ASSERT_EQ(surface.positions[k], all.positions[other]);
          ASSERT_EQ(surface.areas[k], all.areas[other]);
          ASSERT_EQ(surface.faced[k], all.faced[other]);
        }
    }
}
