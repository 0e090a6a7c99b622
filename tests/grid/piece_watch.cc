// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "grid/room.h"

constexpr double h = 50.;

/** Blocks of full grid cells, three wide, whose lower corners stand here, in
 *  grid spacings. */
template <int dim>
BodyOnGrid<dim>
blocks(const std::vector<double> &corners)
{
  const double spacing = h / 4.;
  const auto   points =
    lattice_points<dim>(Point<dim>(), 16. * h, spacing, [&](const auto &x) {
      bool inside = false;
      for (const double corner : corners)
        inside = inside || (x[0] > corner * h && x[0] < (corner + 3.) * h);
      for (unsigned int d = 1; d < dim; ++d)
        inside = inside && x[d] > 0. && x[d] < 3. * h;
      return inside;
    });
  return BodyOnGrid<dim>(points, std::pow(spacing, dim));
}

template <int dim>
std::optional<Point<dim>>
joined(PieceWatch<dim> &watch, const BodyOnGrid<dim> &body)
{
  return watch.joined(*body.space, body.grid);
}


TEST_2D_3D(PieceWatch, TellsWherePartsOfTheTissueJoin)
{
  PieceWatch<dim> watch;
  EXPECT_FALSE(joined(watch, blocks<dim>({-12., 0.})).has_value());
  EXPECT_FALSE(joined(watch, blocks<dim>({-6., 1.})).has_value());
  EXPECT_FALSE(joined(watch, blocks<dim>({-5., -1.})).has_value());

  // The gap is a quarter of h now: no empty layer between them.
  const auto near = blocks<dim>({-4.25, -1.});
  ASSERT_EQ(near.space->n_pieces(), 1u);
  const auto place = joined(watch, near);
  ASSERT_TRUE(place.has_value());
  EXPECT_LE(std::abs((*place)[0] + h), h) << *place;
  for (unsigned int d = 1; d < dim; ++d)
    {
      EXPECT_GT((*place)[d], 0.);
      EXPECT_LT((*place)[d], 3. * h);
    }
  // Told once.
  EXPECT_FALSE(joined(watch, near).has_value());
  // It tears, and joins again.
  EXPECT_FALSE(joined(watch, blocks<dim>({-6., -1.})).has_value());
  EXPECT_TRUE(joined(watch, near).has_value());
}


TEST_2D_3D(PieceWatch, ComparesPiecesNotTheirNumber)
{
  if (dim == 3)
    ONE_RANK_IS_ENOUGH();
  PieceWatch<dim> watch;
  EXPECT_FALSE(joined(watch, blocks<dim>({-14., -4., 2.})).has_value());
  // The first one moves on, the others stay apart.
  EXPECT_FALSE(joined(watch, blocks<dim>({-13., -4., 2.})).has_value());
  // Two join while a fourth body comes into being: as many pieces as before.
  EXPECT_FALSE(joined(watch, blocks<dim>({-13., -3., 2.})).has_value());
  const auto changed = blocks<dim>({-13., -1.5, 2., 8.});
  EXPECT_EQ(changed.space->n_pieces(), 3u);
  const auto place = joined(watch, changed);
  ASSERT_TRUE(place.has_value());
  EXPECT_LE(std::abs((*place)[0] - 2. * h), 1.5 * h) << *place;
}


TEST(PieceWatch, CountsPiecesThatHoldCells)
{
  EXPECT_EQ(pieces_with_cells(*blocks<2>({0.}).space, MPI_COMM_WORLD), 1u);
  EXPECT_EQ(pieces_with_cells(*blocks<3>({-14., -4., 2.}).space,
                              MPI_COMM_WORLD),
            3u);
}
