// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

constexpr double L = 10.; // of the lattice, µm


/** A lattice of cells around the origin, stretched by F. */
template <int dim>
PointList<dim>
cells(const Tensor<2, dim> &F)
{
  PointList<dim> list = cells_at(lattice_points<dim>(40., L), std::pow(L, dim));
  for (std::size_t i = 0; i < list.size(); ++i)
    {
      list.positions[i] = Point<dim>(F * list.positions[i]);
      CellColumns<dim>().deformation.set(list.row(i), F);
    }
  return list;
}

/** One boundary point of each condition at the same place. */
template <int dim>
PointList<dim>
boundary_points(const Point<dim> &x, const Tensor<1, dim> &N)
{
  const BoundaryColumns<dim> columns;
  PointList<dim>             list(columns.n_numbers());
  for (const auto condition : {SurfaceCondition::free,
                               SurfaceCondition::fixed,
                               SurfaceCondition::slip,
                               SurfaceCondition::loaded})
    list.add(list.size(), x, columns.initial_point(x, N, 1., condition));
  return list;
}

/** Taken back are the free, slip and loaded points, if any. */
template <int dim>
void
check(const double distance, const double h, const unsigned int n_detached)
{
  SCOPED_TRACE(distance);
  Tensor<2, dim> F = unit_tensor<dim>();
  F[0][0]          = 2.;
  // Out of the middle of the end, on a line with a row of cells.
  Point<dim> end, x;
  for (unsigned int d = 0; d < dim; ++d)
    end[d] = x[d] = 0.5 * L * F[d][d];
  const PointList<dim> all = cells<dim>(F);
  for (const Point<dim> &y : all.positions)
    end[0] = std::max(end[0], y[0]);
  x[0] = end[0] + distance;
  Tensor<1, dim> N; // the slip plane is oblique to the way back
  N[0] = 0.6;
  N[1] = 0.8;

  Tissue<dim> tissue(grid_of_spacing(h), CellColumns<dim>(), MPI_COMM_WORLD);
  tissue.place(dealt(all), dealt(boundary_points<dim>(x, N)));
  EXPECT_EQ(pull_back_detached_points(tissue), n_detached);

  const double               reach = 4. / 3. * std::max(1.5 * 2. * L, 0.25 * h);
  const BoundaryPoints<dim> &points = tissue.boundary_points();
  for (unsigned int p = 0; p < points.size(); ++p)
    {
      const BoundaryView<dim> point = points[p];
      const Point<dim>        now   = points.position(p);
      if (n_detached == 0 || point.condition() == SurfaceCondition::fixed)
        {
          EXPECT_EQ(now.distance(x), 0.);
          EXPECT_EQ((point.F() - unit_tensor<dim>()).norm(), 0.);
          continue;
        }
      EXPECT_LE((point.F() - F).norm(), 1e-14);
      if (point.condition() == SurfaceCondition::slip)
        EXPECT_NEAR((now - x) * N, 0., 1e-12);
      else
        EXPECT_NEAR(now.distance(end), reach, 1e-10);
      EXPECT_LT(now.distance(end), distance);
    }
  EXPECT_EQ(sum_over_ranks(points.size()), 4u);
}

/** Points at the surface are attached; those beyond it by their distance. */
template <int dim>
void
check_attachment()
{
  Tissue<dim> tissue(grid_of_spacing(25.), CellColumns<dim>(), MPI_COMM_WORLD);
  const PointList<dim> all = cells<dim>(unit_tensor<dim>());
  Point<dim>           end;
  for (const Point<dim> &y : all.positions)
    if (y[0] > end[0])
      end = y;
  std::vector<Point<dim>> places(3, end);
  places[0][0] += 5.;
  places[1][0] += 17.5; // reach: 15
  places[2][0] += 40.;
  PointList<dim> surface(BoundaryColumns<dim>().n_numbers());
  for (const Point<dim> &x : places)
    {
      Tensor<1, dim> N;
      N[0] = 1.;
      surface.add(surface.size(), x, boundary_points<dim>(x, N).row(0));
    }
  tissue.place(dealt(all), dealt(surface));
  std::vector<Point<dim>>    mine;
  std::vector<double>        expected;
  const BoundaryPoints<dim> &points = tissue.boundary_points();
  for (unsigned int p = 0; p < points.size(); ++p)
    {
      mine.push_back(points.position(p));
      expected.push_back(std::vector<double>{1., 0.5, 0.}[points.id(p)]);
    }
  const auto found = attachment(mine, tissue);
  ASSERT_EQ(found.size(), expected.size());
  for (unsigned int k = 0; k < found.size(); ++k)
    EXPECT_NEAR(found[k], expected[k], 1e-12);
}


TEST_2D_3D(DetachedPoints, ArePulledBackToTheTissue)
{
  check<dim>(39.9, 25., 0);
  check<dim>(40.1, 25., 3);
  check<dim>(200., 25., 3);
  check<dim>(66., 200., 0); // a third of a grid cell
  check<dim>(80., 200., 3);
}


TEST_2D_3D(DetachedPoints, BelongLessToTheTissue)
{
  check_attachment<dim>();
}
