// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

constexpr double length = 10.; // of cells, um
constexpr int    n      = 8;   // of them along an edge
constexpr double edge   = n * length;

template <int dim>
CellColumns<dim>
with_growth()
{
  CellColumns<dim> columns;
  columns.need_growth();
  return columns;
}

/** A box of cells in its surface, from the origin on. The half at small x
 *  has @p overlap of its own volume too much, the other half too little.
 *  Every second cell has grown by @p growth, and been pressed to the volume
 *  of the others. */
template <int dim>
void
place(Tissue<dim> &tissue, const double overlap, const double growth)
{
  const CellColumns<dim>     columns = with_growth<dim>();
  const BoundaryColumns<dim> boundary_columns;
  PointList<dim>             cells(columns.n_numbers());
  PointList<dim>             surface(boundary_columns.n_numbers());
  const auto                 squeezed = [overlap](const double x) {
    const double middle = 0.5 * edge;
    return x < middle ? x * (1. - overlap) :
                                        middle * (1. - overlap) + (x - middle) * (1. + overlap);
  };
  for (unsigned int i = 0; i < Utilities::pow(n, dim); ++i)
    {
      Point<dim>   x;
      unsigned int rest = i;
      for (unsigned int d = 0; d < dim; ++d, rest /= n)
        x[d] = (rest % n + 0.5) * length;
      for (unsigned int d = 0; d < dim; ++d)
        if (x[d] < length || x[d] > edge - length)
          {
            Point<dim>     y = x;
            Tensor<1, dim> normal;
            normal[d] = x[d] < length ? -1. : 1.;
            y[d]      = x[d] < length ? 0. : edge;
            surface.add(surface.size(),
                        y,
                        make_array_view(boundary_columns.initial_point(
                          y,
                          normal,
                          Utilities::fixed_power<dim - 1>(length),
                          SurfaceCondition::free)));
          }
      x[0] = squeezed(x[0]);
      std::vector<double> row =
        columns.founder(x, Utilities::fixed_power<dim>(length));
      if (i % 2 == 0)
        columns.growth.set(make_array_view(row),
                           std::pow(growth, 1. / dim) * unit_tensor<dim>());
      cells.add(i, x, make_array_view(row));
    }
  tissue.place(dealt(cells), dealt(surface));
}


/** The mean of the cells' x, um, and the least depth of one below the
 *  surface. */
template <int dim>
std::array<double, 2>
middle_and_depth(const Tissue<dim> &tissue)
{
  double sum = 0., depth = edge;
  for (const Point<dim> &x : tissue.cells().positions())
    {
      sum += x[0];
      for (unsigned int d = 0; d < dim; ++d)
        depth = std::min({depth, x[d], edge - x[d]});
    }
  return {{sum_over_ranks(sum) / Utilities::pow(n, dim),
           Utilities::MPI::min(depth, MPI_COMM_WORLD)}};
}

/** The largest distance of a cell from where it was placed, um. */
template <int dim>
double
farthest(const Tissue<dim> &tissue)
{
  double way = 0.;
  for (unsigned int p = 0; p < tissue.cells().size(); ++p)
    way = std::max(way,
                   tissue.cells().position(p).distance(
                     tissue.cells().founder_position(p)));
  return Utilities::MPI::max(way, MPI_COMM_WORLD);
}

// Cells that have grown unevenly move until their centre is that of the body,
// and no farther; none leaves it. Two half steps are about a whole.
TEST_2D_3D(EvenSpread, FillsTheBody)
{
  if (dim == 3)
    ONE_RANK_IS_ENOUGH();
  Tissue<dim> tissue(grid_of_spacing(25.), with_growth<dim>(), MPI_COMM_WORLD);
  place(tissue, 0.2, 2.);
  const double before = middle_and_depth(tissue)[0] - 0.5 * edge;
  EXPECT_NEAR(before, -0.05 * edge, 1e-9);
  for (unsigned int step = 0; step < 60; ++step)
    {
      spread_uneven_growth(tissue, 0.125);
      EXPECT_GT(middle_and_depth(tissue)[1], 0.2 * length);
    }
  EXPECT_LT(std::abs(middle_and_depth(tissue)[0] - 0.5 * edge),
            0.2 * std::abs(before));
  for (unsigned int p = 0; p < tissue.cells().size(); ++p)
    EXPECT_EQ(tissue.cells().volume(p), Utilities::fixed_power<dim>(length));

  std::array<double, 2> ways;
  for (const unsigned int n_steps : {1, 2})
    {
      Tissue<dim> other(grid_of_spacing(25.),
                        with_growth<dim>(),
                        MPI_COMM_WORLD);
      place(other, 0.2, 1.1);
      for (unsigned int step = 0; step < n_steps; ++step)
        spread_uneven_growth(other, 0.1 / n_steps);
      ways[n_steps - 1] = middle_and_depth(other)[0] - 0.5 * edge - before;
    }
  EXPECT_GT(ways[0], 0.);
  EXPECT_NEAR(ways[1] / ways[0], 1., 0.05);
}

// Cells that fill their body evenly stay, also along its edges, and those that
// have grown alike stay whatever they fill.
TEST_2D_3D(EvenSpread, MovesNoMoreThanNeeded)
{
  Tissue<dim> filled(grid_of_spacing(25.), with_growth<dim>(), MPI_COMM_WORLD);
  place(filled, 0., 2.);
  spread_uneven_growth(filled, 0.125);
  EXPECT_LT(farthest(filled), 1e-9 * length);

  Tissue<dim> alike(grid_of_spacing(25.), with_growth<dim>(), MPI_COMM_WORLD);
  place(alike, 0.2, 1.);
  const std::vector<Point<dim>> before = alike.cells().positions();
  spread_uneven_growth(alike, 0.125);
  EXPECT_EQ(alike.cells().positions(), before);
}
