// ranks: 1 2 4
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/grid/grid_window.h>
#include <morula/grid/spline_space.h>

#include <gtest/gtest.h>

#include <vector>

#include "common/body_on_grid.h"

using namespace Morula;

namespace
{
  constexpr double h = 50.;

  template <int dim>
  Point<dim>
  on_x_axis(const double x)
  {
    Point<dim> point;
    point[0] = x;
    return point;
  }

  /** Two balls that stand a distance apart, in grid spacings. */
  template <int dim>
  std::vector<Point<dim>>
  two_balls(const double distance)
  {
    std::vector<Point<dim>> points =
      ball_points(on_x_axis<dim>(-distance * h / 2.), 2. * h, h / 4.);
    const auto other =
      ball_points(on_x_axis<dim>(distance * h / 2.), 2. * h, h / 4.);
    points.insert(points.end(), other.begin(), other.end());
    return points;
  }

  /** Grid cells in the largest window of a rank, where every rank knows its own
   *  points alone. */
  template <int dim>
  unsigned int
  largest_window(const std::vector<Point<dim>> &points)
  {
    const BodyOnGrid<dim> body(points, std::pow(h / 4., dim));
    const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    std::vector<typename GridWindow<dim>::Extent> extents;
    for (const Point<dim> &x : points)
      if (body.grid.owner(body.grid.box().locate(x)) == rank)
        extents.emplace_back(x, x);
    return Utilities::MPI::max(GridWindow<dim>(body.grid, extents).box().size(),
                               MPI_COMM_WORLD);
  }

  /** The tables of a rank do not grow with the grid's box. No rank may have
   *  parts of both balls: so the number of ranks is even. */
  template <int dim>
  void
  check_size()
  {
    const unsigned int near = largest_window(two_balls<dim>(80.));
    const unsigned int far  = largest_window(two_balls<dim>(240.));
    if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1)
      {
        EXPECT_GT(far, 2 * near);
      }
    else
      {
        // a ball, what splines reach, the rings
        EXPECT_LE(near, Utilities::pow(5 + 2 * (2 + 12), dim));
        EXPECT_LE(far, Utilities::pow(5 + 2 * (2 + 12), dim));
      }
  }

  /** All ranks' windows together hold what each must know. */
  template <int dim>
  void
  check_contents()
  {
    const auto            points = two_balls<dim>(30.);
    const BodyOnGrid<dim> body(points, std::pow(h / 4., dim));
    const GridBox<dim>   &whole = body.grid.box();
    const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const unsigned int n_ranks =
      Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
    // Each rank has some of the points, wherever they stand.
    std::vector<typename GridWindow<dim>::Extent> extents;
    for (std::size_t i = rank; i < points.size(); i += n_ranks)
      extents.emplace_back(points[i], points[i]);
    GridWindow<dim> window(body.grid, extents);
    for (const auto &[x, same] : extents)
      EXPECT_TRUE(window.holds(whole.locate(x), 12));
    for (const Point<dim> &x : points)
      if (body.grid.owner(whole.locate(x)) == rank)
        {
          EXPECT_TRUE(window.holds(whole.locate(x), 12));
        }
    window.widen();
    for (const auto &[x, same] : extents)
      EXPECT_TRUE(window.holds(whole.locate(x), 24));

    struct Record
    {
      unsigned int number, n;
    };
    std::vector<Record> counted;
    for (const auto &[x, same] : extents)
      counted.push_back({whole.number(whole.locate(x)), 1});
    const auto own = window.to_owners(counted, body.grid);
    EXPECT_EQ(Utilities::MPI::sum<unsigned int>(own.size(), MPI_COMM_WORLD),
              points.size());
    for (const Record &record : own)
      EXPECT_EQ(body.grid.owner(record.number), rank);
    unsigned int n_elsewhere = 0;
    for (const Point<dim> &x : points)
      n_elsewhere += body.grid.owner(whole.locate(x)) != rank &&
                     window.box().contains(whole.locate(x));
    EXPECT_EQ(window.to_windows(own).size(), n_elsewhere);
  }
} // namespace


TEST(GridWindow, DoesNotGrowWithTheBox){MORULA_BOTH_DIMENSIONS(check_size)}


TEST(GridWindow, HoldsWhatARankMustKnow)
{
  MORULA_BOTH_DIMENSIONS(check_contents)
}
