// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
// ranks: 1 3

#include "particles/room.h"

/** Columns of cells whose places are kept. */
template <int dim>
CellColumns<dim>
columns_with_strain(const bool with_bodies = false,
                    const bool with_parts  = false)
{
  CellColumns<dim> columns;
  columns.need_step_strain();
  if (with_bodies)
    columns.need_bodies(with_parts);
  return columns;
}

/** A cell with the volume @p V (um^dim) that the step has strained. */
template <int dim>
void
add_cell(PointList<dim>         &list,
         const CellColumns<dim> &columns,
         const Point<dim>       &x,
         const double            V,
         const double            strain)
{
  std::vector<double> row = columns.founder(x, V);
  columns.step_strain.set(make_array_view(row), strain);
  list.add(list.size(), x, make_array_view(row));
}

/** A patch at @p x with the outward normal @p n and the size @p a (um). */
template <int dim>
void
add_patch(PointList<dim>             &list,
          const BoundaryColumns<dim> &columns,
          const Point<dim>           &x,
          const Tensor<1, dim>       &n,
          const double                a)
{
  list.add(
    list.size(),
    x,
    make_array_view(columns.initial_point(
      x, n, Utilities::fixed_power<dim - 1>(a), SurfaceCondition::free)));
}

/** The positions of all ranks' cells by id. */
template <int dim>
std::vector<Point<dim>>
places_of(const Tissue<dim> &tissue)
{
  return of_all_ranks(tissue.cells().copy(), tissue.communicator()).positions;
}

// Lattices have no cell nearer than the law wants it: no bit changes, however
// much a step strains them.
TEST_2D_3D(Places, LatticesStay)
{
  // Edges of the cell of the lattice, in lengths of a cell, and a second cell
  // in it.
  struct Lattice
  {
    double edge, height;
    bool   has_two;
  };
  const double               hexagonal = std::sqrt(2. / std::sqrt(3.));
  const std::vector<Lattice> lattices =
    dim == 2 ?
      std::vector<Lattice>{{1., 1., false},
                           {hexagonal, std::sqrt(3.) * hexagonal, true}} :
      std::vector<Lattice>{{1., 1., false},
                           {std::cbrt(2.), std::cbrt(2.), true}};
  for (const Lattice &lattice : lattices)
    {
      const auto     columns = columns_with_strain<dim>();
      PointList<dim> cells(columns.n_numbers());
      for (unsigned int i = 0; i < Utilities::pow(6u, dim); ++i)
        for (unsigned int k = 0; k <= lattice.has_two; ++k)
          {
            Point<dim>   x;
            unsigned int rest = i;
            for (unsigned int d = 0; d < dim; ++d, rest /= 6)
              x[d] = 10. * (rest % 6 + 0.5 * k) *
                     (d == 1 ? lattice.height : lattice.edge);
            add_cell(cells, columns, x, Utilities::fixed_power<dim>(10.), 1.);
          }
      Tissue<dim> tissue(grid_of_spacing(30.), columns, MPI_COMM_WORLD);
      tissue.place(dealt(cells),
                   PointList<dim>(BoundaryColumns<dim>().n_numbers()));
      EXPECT_EQ(keep_apart(tissue), 0.);
      EXPECT_EQ(places_of(tissue), cells.positions);
    }
}

// One pass takes half of the overlap of two cells, and their centre of volume
// stays; other bodies, folds and strain that is none do not count.
TEST_2D_3D(Places, TwoCellsPart)
{
  const double l = 10., r = 6.;
  for (const std::string kind :
       {"alone", "at rest", "bodies", "folds", "surface"})
    {
      const auto columns =
        columns_with_strain<dim>(kind == "bodies" || kind == "folds",
                                 kind == "folds");
      BoundaryColumns<dim> of_points;
      if (columns.body.exists())
        of_points.need_bodies(false, kind == "folds");
      PointList<dim> cells(columns.n_numbers()), patches(of_points.n_numbers());
      Tensor<1, dim> axis;
      axis[0]             = 0.6;
      axis[1]             = 0.8;
      const double V[2]   = {Utilities::fixed_power<dim>(0.8 * l),
                             Utilities::fixed_power<dim>(1.2 * l)};
      const double strain = kind == "at rest" ? 0. : 1. / 30.;
      add_cell(cells, columns, Point<dim>(), V[0], strain);
      add_cell(cells, columns, Point<dim>(r * axis), V[1], strain);
      if (kind == "bodies")
        columns.body.set(cells.row(1), 1);
      if (kind == "folds")
        for (const double side : {-1., 1.})
          add_patch<dim>(patches,
                         of_points,
                         Point<dim>((0.5 * r + 0.1 * side) * axis),
                         -side * axis,
                         6.);
      if (kind == "surface")
        add_patch<dim>(patches, of_points, Point<dim>(-1. * axis), -axis, 6.);
      Tissue<dim> tissue(grid_of_spacing(30.),
                         columns,
                         MPI_COMM_WORLD,
                         of_points);
      tissue.place(dealt(cells), dealt(patches));
      keep_apart(tissue);
      const auto   x    = places_of(tissue);
      const double more = 0.5 * (0.95 * l - r);
      if (kind == "alone")
        {
          EXPECT_NEAR(x[0].distance(x[1]), r + more, 1e-12 * l);
          EXPECT_NEAR((V[0] * x[0] + V[1] * (x[1] - r * axis)).norm(),
                      0.,
                      1e-12 * l * V[0]);
        }
      else if (kind == "surface")
        {
          // The first cell is less than a quarter of its length deep.
          EXPECT_NEAR(x[0].norm(), 0., 1e-12 * l);
          EXPECT_NEAR(x[1].distance(Point<dim>()),
                      r + more * V[0] / (V[0] + V[1]),
                      1e-12 * l);
        }
      else
        EXPECT_EQ(x, cells.positions) << kind;
    }
}

// Cells that were strewn by chance part: the nearest pair comes ever farther
// apart. Places are the same to the bit on any number of ranks.
TEST_2D_3D(Places, StrewnCellsPart)
{
  const double                           l       = 10.;
  const unsigned                         n       = dim == 2 ? 300 : 600;
  const auto                             columns = columns_with_strain<dim>();
  PointList<dim>                         cells(columns.n_numbers());
  std::mt19937                           generator(7);
  std::uniform_real_distribution<double> uniform(0., std::pow(n, 1. / dim) * l);
  for (unsigned int i = 0; i < n; ++i)
    {
      Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = uniform(generator);
      add_cell(cells, columns, x, Utilities::fixed_power<dim>(l), 1.);
    }
  Tissue<dim> tissue(grid_of_spacing(25.), columns, MPI_COMM_WORLD),
    alone(grid_of_spacing(25.), columns, MPI_COMM_SELF);
  const PointList<dim> none(BoundaryColumns<dim>().n_numbers());
  tissue.place(dealt(cells), none);
  alone.place(cells, none);
  const auto nearest = [](const std::vector<Point<dim>> &x) {
    double least = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        least = std::min(least, x[i].distance(x[j]));
    return least;
  };
  double before = 0., close = 1.;
  for (unsigned int step = 0; step < 8; ++step)
    {
      close             = keep_apart(tissue);
      const double same = keep_apart(alone);
      EXPECT_EQ(close, same);
      const auto places = places_of(alone);
      EXPECT_EQ(places_of(tissue), places);
      const double now = nearest(places);
      EXPECT_GT(now, before);
      before = now;
    }
  EXPECT_GT(before, 0.6 * l);
  EXPECT_EQ(close, 0.);
}
