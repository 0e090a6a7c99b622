// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

constexpr double h = 50.;

/** Two balls whose middles stand so many grid spacings apart along x. */
template <int dim>
std::vector<Point<dim>>
two_balls(const double distance)
{
  Point<dim> middle;
  middle[0]         = distance * h / 2.;
  auto       points = ball_points(middle, 2. * h, h / 4.);
  const auto other  = ball_points(-1. * middle, 2. * h, h / 4.);
  points.insert(points.end(), other.begin(), other.end());
  return points;
}

/** Bytes that a rank asks for while it makes window, occupancy and splines
 *  of a body: the most of any rank. */
template <int dim>
std::size_t
bytes_of_splines(const std::vector<Point<dim>> &points)
{
  const double                     V = std::pow(h / 4., dim);
  const BodyOnGrid<dim>            body(points, V);
  const unsigned int               rank = this_rank();
  std::vector<ParticleDomain<dim>> own;
  for (const Point<dim> &x : points)
    if (body.grid.owner(body.grid.locate(x)) == rank)
      own.emplace_back(x, V);
  const auto reached = ranges_of(own, body.grid);

  const std::size_t before = bytes_asked_for();
  Occupancy<dim>    occupancy(GridWindow<dim>(body.grid, reached));
  occupy(occupancy, body.grid, own);
  const SplineSpace<dim> space(body.grid,
                               std::move(occupancy),
                               GridParameters());
  const std::size_t      bytes = bytes_asked_for() - before;
  EXPECT_EQ(space.n_pieces(), 2u);
  return Utilities::MPI::max(bytes, MPI_COMM_WORLD);
}


// Two bodies in a box of eight times as many grid cells: a rank has tables for
// the bodies, also one that has parts of both. (Both boxes are wider than any
// window.)
TEST_2D_3D(GridWindow, TablesDoNotGrowWithTheBox)
{
  if (dim == 3)
    ONE_RANK_IS_ENOUGH();
  const auto near = bytes_of_splines(two_balls<dim>(100.));
  const auto far  = bytes_of_splines(two_balls<dim>(800.));
  EXPECT_GT(near, 1000u);
  EXPECT_LT(far, 1.1 * near);
}


// All ranks' windows together hold what each must know.
TEST_2D_3D(GridWindow, HoldsWhatARankMustKnow)
{
  const auto            points = two_balls<dim>(30.);
  const BodyOnGrid<dim> body(points, std::pow(h / 4., dim));
  const GridBox<dim>   &whole   = body.grid.box();
  const unsigned int    rank    = this_rank();
  const unsigned int    n_ranks = number_of_ranks();
  // Each rank has some of the points, wherever they stand.
  std::vector<GridIndex<dim>> mine;
  for (std::size_t i = rank; i < points.size(); i += n_ranks)
    mine.push_back(whole.locate(points[i]));
  std::vector<GridRange<dim>> reached;
  for (const GridIndex<dim> &index : mine)
    reached.push_back({index, index});
  GridWindow<dim> window(body.grid, reached);
  for (const GridIndex<dim> &index : mine)
    EXPECT_TRUE(window.holds(index, 12));
  for (const Point<dim> &x : points)
    if (body.grid.owner(whole.locate(x)) == rank)
      {
        EXPECT_TRUE(window.holds(whole.locate(x), 12));
      }
  const unsigned int size = window.size();
  window.widen(rank % 2 == 1); // some ranks
  for (const GridIndex<dim> &index : mine)
    EXPECT_TRUE(window.holds(index, rank % 2 == 1 ? 18 : 12));
  if (rank % 2 == 0)
    {
      EXPECT_EQ(window.size(), size);
    }

  struct Record
  {
    unsigned int number, n;
  };
  std::vector<Record> counted;
  for (const GridIndex<dim> &index : mine)
    counted.push_back({whole.number(index), 1});
  const auto own = window.to_owners(counted, body.grid);
  EXPECT_EQ(sum_over_ranks<unsigned int>(own.size()), points.size());
  for (const Record &record : own)
    EXPECT_EQ(body.grid.owner(record.number), rank);
  unsigned int n_elsewhere = 0;
  for (const Point<dim> &x : points)
    n_elsewhere += body.grid.owner(whole.locate(x)) != rank &&
                   window.contains(whole.locate(x));
  EXPECT_EQ(window.to_windows(own).size(), n_elsewhere);
}
