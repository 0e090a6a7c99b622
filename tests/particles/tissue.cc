// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

/** Makes cells of marked points: V⁰ and F that a cell can have. */
template <int dim>
void
make_cells(PointList<dim> &points)
{
  const CellColumns<dim> columns;
  for (std::size_t i = 0; i < points.size(); ++i)
    {
      const CellView<dim, double> cell(points.row(i), columns);
      cell.set(columns.initial_volume, 500. + points.ids[i]);
      cell.set(columns.deformation, unit_tensor<dim>());
    }
}

template <int dim>
struct Points
{
  PointList<dim> cells, boundary;

  explicit Points(const unsigned int seed)
    : cells(random_points<dim>(400, 150., CellColumns<dim>().n_numbers(), seed))
    , boundary(random_points<dim>(
        150, 160., BoundaryColumns<dim>().n_numbers(), seed + 1))
  {
    make_cells(cells);
  }

  /** Moves all points by @p by, and each a bit by itself. */
  void
  move(const Tensor<1, dim> &by, const double shake, const unsigned int seed)
  {
    std::mt19937 generator(seed);
    for (auto *list : {&cells, &boundary})
      for (Point<dim> &x : list->positions)
        x += by + shake * random_tensor<1, dim>(generator);
  }
};

template <int dim>
void
expect_tissue(const Tissue<dim> &tissue, const Points<dim> &points)
{
  expect_same_points(tissue.cells().copy(), owned(points.cells, tissue.grid()));
  expect_same_points(tissue.boundary_points().copy(),
                     owned(points.boundary, tissue.grid()));
}

template <int dim>
Tissue<dim>
make_tissue()
{
  return {GridParameters(), CellColumns<dim>(), MPI_COMM_WORLD};
}

/** Replaces every fifth cell by two at @p distance on both sides. */
template <int dim>
void
check_replacement(const double distance)
{
  Points<dim> points(3);
  auto        tissue = make_tissue<dim>();
  tissue.place(dealt(points.cells), dealt(points.boundary));

  std::vector<unsigned int> mothers;
  PointList<dim>            daughters(points.cells.n_numbers);
  const auto                is_mother = [](const types::particle_index id) {
    return id % 5 == 0;
  };
  const auto divide = [&](const types::particle_index id,
                          const Point<dim>           &x,
                          PointList<dim>             &list) {
    Tensor<1, dim> by;
    by[id % dim] = distance;
    append(list, 1000 + 2 * id, x - by);
    append(list, 1001 + 2 * id, x + by);
    make_cells(list);
  };
  const Cells<dim> &cells = tissue.cells();
  for (unsigned int p = 0; p < cells.size(); ++p)
    if (is_mother(cells.id(p)))
      {
        mothers.push_back(p);
        divide(cells.id(p), cells.position(p), daughters);
      }
  tissue.replace(mothers, daughters);

  Points<dim> after = points;
  after.cells       = selected(points.cells, [&](const std::size_t i) {
    return !is_mother(points.cells.ids[i]);
  });
  for (std::size_t i = 0; i < points.cells.size(); ++i)
    if (is_mother(points.cells.ids[i]))
      divide(points.cells.ids[i], points.cells.positions[i], after.cells);
  expect_tissue(tissue, after);
  EXPECT_EQ(sum_over_ranks<unsigned int>(cells.size()), after.cells.size());
}


TEST_2D_3D(Tissue, LosesNoPointHoweverFarItMoves)
{
  Points<dim> points(1);
  auto        tissue = make_tissue<dim>();
  tissue.place(dealt(points.cells), dealt(points.boundary));
  expect_tissue(tissue, points);
  const auto box = tissue.grid().box();

  // Several grid cells, far outside of the box, back, blown up.
  Tensor<1, dim> by;
  unsigned int   seed = 10;
  for (const double distance : {0., 20., 260., -5000., 4800.})
    {
      if (dim == 3 && std::abs(distance) > 1000.)
        continue;
      SCOPED_TRACE("moved by " + std::to_string(distance));
      by[0]       = distance;
      by[dim - 1] = -0.5 * distance;
      // From where they are, as in a step: each rank moves its own.
      PointList<dim> cells    = tissue.cells().copy();
      PointList<dim> boundary = tissue.boundary_points().copy();
      points.move(by, 40., ++seed);
      const auto follow = [](PointList<dim> &mine, const PointList<dim> &all) {
        for (std::size_t i = 0; i < mine.size(); ++i)
          for (std::size_t k = 0; k < all.size(); ++k)
            if (all.ids[k] == mine.ids[i])
              mine.positions[i] = all.positions[k];
      };
      follow(cells, points.cells);
      follow(boundary, points.boundary);
      tissue.place(cells, boundary);
      expect_tissue(tissue, points);
    }
  for (auto *list : {&points.cells, &points.boundary})
    for (Point<dim> &x : list->positions)
      x *= 3.;
  tissue.place(dealt(points.cells), dealt(points.boundary));
  expect_tissue(tissue, points);
  EXPECT_GT(tissue.grid().box().size(), box.size());
}


// A tissue that stays inside its padding keeps its grid.
TEST_2D_3D(Tissue, KeepsItsGridInsideThePadding)
{
  Points<dim> points(2);
  auto        tissue = make_tissue<dim>();
  tissue.place(dealt(points.cells), dealt(points.boundary));
  const auto     first = tissue.grid().box().first();
  const auto     n     = tissue.grid().box().n();
  Tensor<1, dim> by;
  by[0] = 50.;
  points.move(by, 0., 1);
  tissue.place(dealt(points.cells), dealt(points.boundary));
  EXPECT_EQ(tissue.grid().box().first(), first);
  EXPECT_EQ(tissue.grid().box().n(), n);
  expect_tissue(tissue, points);

  // As a snapshot has it: the same box and partition again.
  auto again = make_tissue<dim>();
  again.restore(dealt(points.cells),
                dealt(points.boundary),
                first,
                n,
                tissue.grid().weights());
  expect_tissue(again, points);
  for (unsigned int number = 0; number < tissue.grid().box().size(); ++number)
    EXPECT_EQ(again.grid().owner(number), tissue.grid().owner(number));
  ASSERT_EQ(again.cells().size(), tissue.cells().size());
  for (unsigned int p = 0; p < again.cells().size(); ++p)
    EXPECT_EQ(again.cells().id(p), tissue.cells().id(p));
}


TEST_2D_3D(Tissue, ReplacesMothersByDaughters)
{
  check_replacement<dim>(5.);
}


TEST_2D_3D(Tissue, MakesItsGridAnewForDaughtersBeyondIt)
{
  if (dim == 3)
    ONE_RANK_IS_ENOUGH();
  check_replacement<dim>(700.);
}
