// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

constexpr double L = 10., h = 40.; // µm

/** A lattice of cells in a box around the origin, and boundary points at
 *  some places. */
template <int dim>
struct Lattice
{
  Tissue<dim> tissue;

  explicit Lattice(const std::vector<Point<dim>> &places)
    : tissue(grid_of_spacing(h), CellColumns<dim>(), MPI_COMM_WORLD)
  {
    const BoundaryColumns<dim> of_surface;
    PointList<dim>             surface(of_surface.n_numbers());
    Tensor<1, dim>             N;
    N[0] = 1.;
    for (const Point<dim> &x : places)
      surface.add(surface.size(),
                  x,
                  of_surface.initial_point(x, N, 1., SurfaceCondition::fixed));
    tissue.place(dealt(cells_at(lattice_points<dim>(60., L), std::pow(L, dim))),
                 dealt(surface));
  }
};


// Values that are linear are found where there is no cell.
TEST_2D_3D(Surroundings, ReproduceLinearValues)
{
  std::vector<Point<dim>> places;
  for (const double along : {-31., 0., 17.})
    {
      Point<dim> x;
      x[0] = 55.;
      x[1] = along;
      places.push_back(x);
    }
  const Lattice<dim> lattice(places);
  const Tissue<dim> &tissue = lattice.tissue;
  Tensor<2, dim>     slope;
  for (unsigned int i = 0; i < dim; ++i)
    for (unsigned int j = 0; j < dim; ++j)
      slope[i][j] = 1. + i - 2. * j * i;
  const auto linear = [&](const Point<dim> &x) {
    Tensor<1, dim> value = slope * x;
    value[0] += 7.;
    return value;
  };
  const auto mine = tissue.boundary_points().positions();
  const auto found =
    Surroundings<dim>(mine, tissue).values([&](const unsigned int p) {
      return linear(tissue.cells().position(p));
    });
  ASSERT_EQ(found.size(), mine.size());
  for (std::size_t k = 0; k < mine.size(); ++k)
    EXPECT_LE((found[k] - linear(mine[k])).norm(),
              0.02 * linear(mine[k]).norm())
      << mine[k];
  EXPECT_EQ(sum_over_ranks(mine.size()), places.size());
}


// A single cell that differs from its neighbours counts little.
TEST_2D_3D(Surroundings, NoSingleCellDecides)
{
  Point<dim> x;
  x[0] = 55.;
  const Lattice<dim> lattice({x});
  const Tissue<dim> &tissue = lattice.tissue;
  const auto         mine   = tissue.boundary_points().positions();
  // That is the nearest one, or one of the nearest.
  const auto found =
    Surroundings<dim>(mine, tissue).values([&](const unsigned int p) {
      return tissue.cells().position(p).distance(x) < 0.8 * L ? 1. : 0.;
    });
  for (const double value : found)
    {
      EXPECT_GT(value, 0.);
      EXPECT_LT(value, 0.5);
    }
}


TEST_2D_3D(Surroundings, FarAwayThereAreNone)
{
  Point<dim> x;
  x[0] = 55. + h;
  const Lattice<dim> lattice({x});
  const Tissue<dim> &tissue = lattice.tissue;
  const auto         mine   = tissue.boundary_points().positions();
  for (const double value :
       Surroundings<dim>(mine, tissue).values([](const unsigned int) {
         return 1.;
       }))
    EXPECT_EQ(value, 0.);
}
