// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "seeding/room.h"

constexpr double length = 10.; // of cells, um
const auto       comm   = MPI_COMM_WORLD;

/** A tissue of cells that are half as large as they were, and its surface. */
template <int dim>
class Body
{
public:
  explicit Body(const std::function<bool(const Point<dim> &)> &inside)
    : tissue(GridParameters(),
             CellColumns<dim>(),
             comm,
             BoundaryColumns<dim>(true, true))
    , columns(tissue.boundary_points().columns())
    , former(columns.n_numbers())
  {
    const std::vector<Point<dim>> sites =
      lattice_points<dim>(Point<dim>(), 150., length, inside);
    n_cells                          = sites.size();
    const auto [begin, end]          = share(n_cells, comm);
    const CellColumns<dim> &of_cells = tissue.cells().columns();
    PointList<dim>          cells(of_cells.n_numbers());
    const double            stretch = std::pow(0.5, 1. / dim);
    for (auto i = begin; i < end; ++i)
      {
        const double V = 2. * Utilities::fixed_power<dim>(length);
        cells.add(i, sites[i], make_array_view(of_cells.founder(sites[i], V)));
        CellView<dim, double>(cells.row(cells.size() - 1), of_cells)
          .set(of_cells.deformation, stretch * unit_tensor<dim>());
      }
    tissue.place(cells, PointList<dim>());
  }

  /** A former point of the surface, on rank 0. */
  void
  add(const Point<dim>      &x,
      const Tensor<1, dim>  &n,
      const SurfaceCondition condition)
  {
    if (Utilities::MPI::this_mpi_process(comm) > 0)
      return;
    const double area = Utilities::fixed_power<dim - 1>(length);
    // It has come from elsewhere.
    const Point<dim> X = x + shift;
    former.add(former.size(),
               x,
               make_array_view(columns.initial_point(X, n, area, condition)));
    BoundaryView<dim, double>(former.row(former.size() - 1), columns)
      .deform(2. * unit_tensor<dim>());
  }

  /** The points of the new surface, of all ranks, by id. */
  PointList<dim>
  renewed(const PointList<dim> &present)
  {
    const auto list = renewed_surface(tissue.cells(),
                                      former,
                                      present,
                                      columns,
                                      SurfaceWish(),
                                      20.,
                                      next_id,
                                      comm);
    EXPECT_TRUE(list.has_value());
    return of_all_ranks(*list, comm);
  }

  Tissue<dim>                 tissue;
  const BoundaryColumns<dim> &columns;
  PointList<dim>              former;
  std::size_t                 n_cells;
  types::particle_index       next_id = 1000;
  const Tensor<1, dim>        shift   = Point<dim>::unit_vector(0) * 500.;
};

/** Unit vectors all around. */
template <int dim>
std::vector<Tensor<1, dim>>
directions(const unsigned int n)
{
  std::vector<Tensor<1, dim>> list(n);
  for (unsigned int i = 0; i < n; ++i)
    {
      const double z = dim == 2 ? 0. : 1. - (2. * i + 1.) / n;
      const double angle =
        2. * numbers::PI * i * (dim == 2 ? 1. / n : 0.6180339887);
      list[i][0] = std::sqrt(1. - z * z) * std::cos(angle);
      list[i][1] = std::sqrt(1. - z * z) * std::sin(angle);
      if (dim == 3)
        list[i][2] = z;
    }
  return list;
}


// A ball that has lost the points of a third of its surface: the new one is
// closed, encloses the cells, and is loaded where its neighbours were.
TEST_2D_3D(SurfaceRenewal, EnclosesWhatIsLeft)
{
  Body<dim>      body([](const Point<dim> &x) { return x.norm() < 60.; });
  const auto     all = directions<dim>(dim == 2 ? 40 : 450);
  PointList<dim> present(body.columns.n_numbers());
  for (const Tensor<1, dim> &n : all)
    body.add(Point<dim>(60. * n),
             n,
             n[1] > 0. ? SurfaceCondition::loaded : SurfaceCondition::free);
  for (std::size_t i = 0; i < body.former.size(); ++i)
    if (body.former.positions[i][0] < 20.)
      present.add(body.former.ids[i],
                  body.former.positions[i],
                  ArrayView<const double>(body.former.row(i)));
  const PointList<dim> points = body.renewed(present);
  const PatchSums<dim> sums(points, body.columns);
  EXPECT_LT(sums.vector.norm(), 1e-12 * sums.area);
  EXPECT_NEAR(sums.volume / (body.n_cells * std::pow(length, dim)), 1., 0.01);
  // of about the area that patches shall have
  EXPECT_NEAR(points.size() * std::pow(length, dim - 1) / sums.area, 1., 0.2);
  EXPECT_EQ(body.next_id, 1000 + points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      const BoundaryView<dim> point(points.row(i), body.columns);
      EXPECT_EQ(points.ids[i], 1000 + i);
      EXPECT_LT((point.F() - unit_tensor<dim>()).norm(), 1e-15);
      const Point<dim> &x = points.positions[i];
      EXPECT_LT(point.seed_position().distance(x + body.shift), 20.);
      if (std::abs(x[1]) > 15.)
        {
          EXPECT_EQ(point.condition(),
                    x[1] > 0. ? SurfaceCondition::loaded :
                                SurfaceCondition::free);
        }
    }
}


// A surface that is smooth over more than a cell, and encloses a given volume.
TEST_2D_3D(SurfaceRenewal, EnclosesWhatItShall)
{
  Body<dim> body([](const Point<dim> &x) { return x.norm() < 60.; });
  for (const Tensor<1, dim> &n : directions<dim>(dim == 2 ? 40 : 450))
    body.add(Point<dim>(60. * n), n, SurfaceCondition::free);
  const double volume = 1.03 * body.n_cells * std::pow(length, dim);
  const auto   list   = renewed_surface(body.tissue.cells(),
                                    body.former,
                                    body.former,
                                    body.columns,
                                    SurfaceWish{0., 25., volume},
                                    20.,
                                    body.next_id,
                                    comm);
  ASSERT_TRUE(list.has_value());
  const PointList<dim> points = of_all_ranks(*list, comm);
  const PatchSums<dim> sums(points, body.columns);
  EXPECT_LT(sums.vector.norm(), 1e-12 * sums.area);
  EXPECT_NEAR(sums.volume / volume, 1., 1e-12);
  const double radius = dim == 2 ? std::sqrt(volume / numbers::PI) :
                                   std::cbrt(0.75 * volume / numbers::PI);
  for (const Point<dim> &x : points.positions)
    EXPECT_NEAR(x.norm() / radius, 1., 0.05);
}


// A ball from which a cap was carved: the points that are left stay as they
// are, and the cut is closed.
TEST_2D_3D(SurfaceRenewal, ClosesCuts)
{
  Body<dim> body(
    [](const Point<dim> &x) { return x.norm() < 80. && x[0] < 30.; });
  const unsigned int n_all = dim == 2 ? 50 : 800;
  const double       area =
    (dim == 2 ? 2. * numbers::PI * 80. : 4. * numbers::PI * 6400.) / n_all;
  if (Utilities::MPI::this_mpi_process(comm) == 0)
    for (const Tensor<1, dim> &n : directions<dim>(n_all))
      if (80. * n[0] < 30.)
        body.former.add(
          body.former.size(),
          Point<dim>(80. * n),
          make_array_view(body.columns.initial_point(
            Point<dim>(80. * n), n, area, SurfaceCondition::free)));
  const PointList<dim> former = of_all_ranks(body.former, comm);
  const auto           list   = carved_surface<dim>(
    body.tissue.cells(),
    body.former,
    body.columns,
    [](const Point<dim> &, const Tensor<1, dim> &n) {
      return n[0] > 0.9 ? SurfaceCondition::loaded : SurfaceCondition::free;
    },
    body.next_id,
    comm);
  ASSERT_TRUE(list.has_value());
  const PointList<dim> points = of_all_ranks(*list, comm);
  const PatchSums<dim> sums(points, body.columns);
  EXPECT_LT(sums.vector.norm(), 1e-12 * sums.area);
  EXPECT_NEAR(sums.volume / (body.n_cells * std::pow(length, dim)), 1., 0.04);
  EXPECT_EQ(body.next_id, 1000 + points.size() - former.size());
  unsigned int n_loaded = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      const BoundaryView<dim> point(points.row(i), body.columns);
      const Point<dim>       &x = points.positions[i];
      if (points.ids[i] < 1000)
        {
          EXPECT_EQ(x.distance(former.positions[points.ids[i]]), 0.);
          EXPECT_EQ(point.initial_area(), area);
          continue;
        }
      EXPECT_EQ(x.distance(point.initial_position()), 0.);
      EXPECT_GT(x[0], 10.);
      n_loaded += point.condition() == SurfaceCondition::loaded;
    }
  EXPECT_GT(n_loaded, dim == 2 ? 6u : 50u);
}


// A half ball on a plane along which it slips.
TEST_2D_3D(SurfaceRenewal, LetsHeldPointsBe)
{
  Body<dim> body(
    [](const Point<dim> &x) { return x.norm() < 80. && x[dim - 1] > 0.; });
  for (const Tensor<1, dim> &n : directions<dim>(dim == 2 ? 50 : 800))
    if (n[dim - 1] > 0.)
      body.add(Point<dim>(80. * n), n, SurfaceCondition::free);
  const std::size_t n_free = body.former.size();
  for (const Point<dim> &x :
       lattice_points<dim>(Point<dim>(), 80., length, [](const Point<dim> &x) {
         return x.norm() < 80. && x[dim - 1] > 0. && x[dim - 1] < length;
       }))
    {
      Point<dim> foot = x;
      foot[dim - 1]   = 0.;
      body.add(foot, -Point<dim>::unit_vector(dim - 1), SurfaceCondition::slip);
    }
  const auto n_held = Utilities::MPI::sum(body.former.size() - n_free, comm);
  const PointList<dim> points = body.renewed(body.former);
  std::size_t          n      = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      const BoundaryView<dim> point(points.row(i), body.columns);
      const double            z = points.positions[i][dim - 1];
      if (points.ids[i] < 1000)
        {
          ++n;
          EXPECT_EQ(z, 0.);
          EXPECT_LT((point.F() - 2. * unit_tensor<dim>()).norm(), 1e-15);
        }
      else
        {
          EXPECT_EQ(point.condition(), SurfaceCondition::free);
          // at the edge, which is round, at most
          EXPECT_TRUE(z > 2. || points.positions[i].norm() > 70.);
        }
    }
  EXPECT_EQ(n, n_held);
  EXPECT_GT(points.size(), n_held + (dim == 2 ? 20 : 200));
}


TEST(SurfaceRenewal, NeedsASurface)
{
  Body<3> body([](const Point<3> &x) { return x.norm() < 60.; });
  EXPECT_FALSE(renewed_surface(body.tissue.cells(),
                               body.former,
                               body.former,
                               body.columns,
                               SurfaceWish(),
                               20.,
                               body.next_id,
                               comm));
  EXPECT_EQ(body.next_id, 1000u);
}


// Cells so far apart have no common surface, and the points stay as they are.
TEST(SurfaceRenewal, LetsScatteredCellsBe)
{
  Body<2> body([](const Point<2> &x) {
    return std::abs(std::remainder(x[0] - 5., 80.)) < 1. &&
           std::abs(std::remainder(x[1] - 5., 80.)) < 1.;
  });
  for (const Tensor<1, 2> &n : directions<2>(40))
    body.add(Point<2>(100. * n), n, SurfaceCondition::free);
  EXPECT_FALSE(renewed_surface(body.tissue.cells(),
                               body.former,
                               body.former,
                               body.columns,
                               SurfaceWish(),
                               20.,
                               body.next_id,
                               comm));
}
