// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  using Function = std::function<double(const Point<2> &)>;

  /** Cells of a disc with values and weights, before and after. */
  struct Disc
  {
    /** @param value, weight of a cell at x, µm */
    Disc(const Function &value, const Function &weight)
      : body(ball_points<2>({3., 4.}, 110., 6.), 36.)
      , groups(body.group(body.particles))
    {
      for (const unsigned int i : groups.points)
        {
          before.push_back(value(body.particles[i]));
          weights.push_back(weight(body.particles[i]));
        }
      after    = before;
      negative = keep_positive(after,
                               weights,
                               body.grouped(body.particles, groups),
                               *body.space,
                               MPI_COMM_WORLD);
    }

    /** The sum over all ranks of weights times values. */
    double
    content(const std::vector<double> &values) const
    {
      double sum = 0.;
      for (std::size_t k = 0; k < values.size(); ++k)
        sum += weights[k] * values[k];
      return Utilities::MPI::sum(sum, MPI_COMM_WORLD);
    }

    const Point<2> &
    place(const std::size_t k) const
    {
      return body.particles[groups.points[k]];
    }

    BodyOnGrid<2>       body;
    PointGroups         groups;
    std::vector<double> weights, before, after;
    std::uint64_t       negative;
  };

  double
  one(const Point<2> &)
  {
    return 1.;
  }

  /** Differs from cell to cell. */
  double
  some_weight(const Point<2> &x)
  {
    return 1. + std::abs(std::sin(x[0] * x[1]));
  }

  /** No value is negative or larger than before, and the sum stays. */
  void
  check(const Disc &disc)
  {
    EXPECT_GT(disc.negative, 0u);
    for (std::size_t k = 0; k < disc.after.size(); ++k)
      {
        EXPECT_GE(disc.after[k], 0.);
        EXPECT_LE(disc.after[k], std::max(0., disc.before[k]));
      }
    const double sum = disc.content(disc.before);
    EXPECT_GT(sum, 0.);
    EXPECT_NEAR(disc.content(disc.after), sum, 1e-12 * sum);
  }
} // namespace


TEST(KeepPositive, LeavesWhatIsPositive)
{
  const Disc disc([](const Point<2> &x) { return x.square(); }, some_weight);
  EXPECT_EQ(disc.negative, 0u);
  EXPECT_EQ(disc.after, disc.before);
}


// One cell in a grid cell of positive ones: only those become smaller.
TEST(KeepPositive, TakesFromTheSameGridCell)
{
  const Disc disc(
    [](const Point<2> &x) {
      return x.distance(Point<2>(6., 7.)) < 0.1 ? -2. : 1.;
    },
    some_weight);
  check(disc);
  EXPECT_EQ(disc.negative, 1u);
  const double h = disc.body.grid.box().spacing();
  for (std::size_t k = 0; k < disc.after.size(); ++k)
    if (disc.place(k).distance(Point<2>(6., 7.)) > std::sqrt(2.) * h)
      {
        EXPECT_EQ(disc.after[k], 1.);
      }
}


// Whole grid cells are negative.
TEST(KeepPositive, TakesFromNeighbours)
{
  const Disc disc(
    [](const Point<2> &x) {
      return x.distance(Point<2>(30., 20.)) < 45. ? -0.3 : 1.;
    },
    some_weight);
  check(disc);
  const double h       = disc.body.grid.box().spacing();
  double       largest = 0.;
  for (std::size_t k = 0; k < disc.after.size(); ++k)
    if (disc.place(k).distance(Point<2>(30., 20.)) > 45. + 5. * h)
      largest = std::max(largest, std::abs(disc.after[k] - 1.));
  EXPECT_EQ(largest, 0.);
}


// The neighbours do not suffice.
TEST(KeepPositive, TakesFromAllInTheEnd)
{
  check(Disc([](const Point<2> &x) { return x[0] < 60. ? -0.1 : 2.; },
             some_weight));
}


TEST(KeepPositive, ANegativeSumBecomesZero)
{
  const Disc disc([](const Point<2> &x) { return x[0] < 60. ? -1. : 0.5; },
                  one);
  EXPECT_LT(disc.content(disc.before), 0.);
  EXPECT_EQ(disc.content(disc.after), 0.);
}


// Where nothing is used up, values below zero matter to no other.
TEST(KeepPositive, WithoutWeightsItOnlyCuts)
{
  const Disc disc([](const Point<2> &x) { return x[0]; },
                  [](const Point<2> &) { return 0.; });
  EXPECT_GT(disc.negative, 0u);
  for (std::size_t k = 0; k < disc.after.size(); ++k)
    EXPECT_EQ(disc.after[k], std::max(0., disc.before[k]));
}
