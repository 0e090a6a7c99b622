// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

constexpr double h = 50.; // µm
/** Half the edge of the body and of its inside, in grid spacings. */
constexpr int half = 3, half_inside = 2;
/** Cells per grid spacing. */
constexpr int n = 5;

/** A body of cells on a lattice that fills its grid cells @p fill times. */
template <int dim>
PointList<dim>
overlapping_cells(const double fill)
{
  const CellColumns<dim> columns;
  const unsigned int     n_edge = 2 * half * n;
  PointList<dim>         cells;
  cells.n_numbers = columns.n_numbers();
  for (unsigned int i = 0; i < Utilities::pow(n_edge, dim); ++i)
    {
      Point<dim>   x;
      unsigned int rest = i;
      for (unsigned int d = 0; d < dim; ++d, rest /= n_edge)
        x[d] = ((rest % n_edge) + 0.5) * h / n - half * h;
      cells.positions.push_back(x);
      cells.ids.push_back(i);
      cells.numbers.resize(cells.numbers.size() + cells.n_numbers, 0.);
      const CellView<dim, double> cell(cells.row(i), columns);
      cell.set(columns.initial_volume, fill * std::pow(h / n, dim));
      cell.set(columns.deformation, unit_tensor<dim>());
    }
  return cells;
}

template <int dim>
Occupancy<dim>
occupancy_of(const PointList<dim> &cells, const double V)
{
  GridIndex<dim> first, size;
  first.fill(-half - 2);
  size.fill(2 * half + 4);
  Occupancy<dim> occupancy(GridBox<dim>(first, size, h, Point<dim>()));
  for (const Point<dim> &x : cells.positions)
    occupancy.add_particle({x, V});
  occupancy.sum();
  return occupancy;
}


// det F is fill^(-part) inside, and 1 at the surface.
TEST_2D_3D(EvenFill, OverlapsShrinkAndGapsCloseInside)
{
  for (const double fill : {0.8, 1.0, 1.2})
    for (const double part : {0.25, 1.})
      {
        const PointList<dim> cells = overlapping_cells<dim>(fill);
        const auto           occupancy =
          occupancy_of<dim>(cells, fill * std::pow(h / n, dim));
        Tissue<dim> tissue(GridParameters(), CellColumns<dim>(), MPI_COMM_SELF);
        tissue.place(cells, PointList<dim>(BoundaryColumns<dim>().n_numbers()));
        relax_volumes_to_space(tissue, occupancy, part);

        unsigned int n_inside = 0;
        for (unsigned int p = 0; p < tissue.cells().size(); ++p)
          {
            bool is_inside = true;
            for (unsigned int d = 0; d < dim; ++d)
              is_inside = is_inside && std::abs(tissue.cells().position(p)[d]) <
                                         half_inside * h;
            n_inside += is_inside;
            const auto &F = tissue.cell(p).F();
            EXPECT_NEAR(determinant(F),
                        is_inside ? std::pow(fill, -part) : 1.,
                        1e-9);
            EXPECT_NEAR(F[0][1], 0., 1e-15);
          }
        EXPECT_EQ(n_inside, Utilities::pow(2 * half_inside * n, dim));
      }
}

/** Where the tissue is mostly gaps it is no inside. */
TEST(EvenFill, SparseTissueIsLeftAlone)
{
  const double       fill  = 0.5;
  const PointList<2> cells = overlapping_cells<2>(fill);
  const auto occupancy     = occupancy_of<2>(cells, fill * std::pow(h / n, 2));
  Tissue<2>  tissue(GridParameters(), CellColumns<2>(), MPI_COMM_SELF);
  tissue.place(cells, PointList<2>(BoundaryColumns<2>().n_numbers()));
  relax_volumes_to_space(tissue, occupancy, 1.);
  for (unsigned int p = 0; p < tissue.cells().size(); ++p)
    EXPECT_EQ(tissue.cell(p).F(), unit_tensor<2>());
}
