// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "effects/room.h"

namespace
{
  /** Two cells, 20 µm apart, and a fixed point nearer to the first one. */
  template <int dim>
  struct Problem
  {
    Tissue<dim> tissue;

    explicit Problem(const bool carries)
      : tissue(GridParameters(),
               CellColumns<dim>(),
               MPI_COMM_WORLD,
               columns(carries))
    {
      const CellColumns<dim> of_cells;
      PointList<dim>         cells(of_cells.n_numbers());
      for (const double x : {0., 20.})
        cells.add(cells.size(), at(x), of_cells.founder(at(x), 1000.));
      const BoundaryColumns<dim> &of_surface =
        tissue.boundary_points().columns();
      PointList<dim> surface(of_surface.n_numbers());
      Tensor<1, dim> N;
      N[1] = 1.;
      surface.add(
        0,
        at(9.),
        of_surface.initial_point(at(9.), N, 1., SurfaceCondition::fixed));
      tissue.place(only_first_rank(cells, MPI_COMM_WORLD),
                   only_first_rank(surface, MPI_COMM_WORLD));
    }

    static BoundaryColumns<dim>
    columns(const bool carries)
    {
      BoundaryColumns<dim> list;
      if (carries)
        add_carriers(list);
      return list;
    }

    static Point<dim>
    at(const double x)
    {
      Point<dim> place;
      place[0] = x;
      return place;
    }

    /** What the point takes of the cells, whose value is their id. */
    double
    value() const
    {
      const auto values =
        carrier_values(held_groups(tissue, tissue.splines()).points,
                       tissue,
                       [&](const unsigned int p) -> double {
                         return tissue.cells().id(p);
                       });
      double found = -1.;
      for (const double of_point : values)
        found = of_point;
      return Utilities::MPI::max(found, MPI_COMM_WORLD);
    }

    void
    move_point(const double x)
    {
      tissue.move(tissue.cells().positions(),
                  std::vector<Point<dim>>(tissue.boundary_points().size(),
                                          at(x)));
    }
  };
} // namespace


/** Another cell comes nearer: the point stays with its own, and without the
 *  column it does not. */
TEST_2D_3D(Carriers, PointStaysWithItsCell)
{
  for (const bool carries : {true, false})
    {
      Problem<dim> problem(carries);
      renew_carriers(problem.tissue);
      EXPECT_EQ(problem.value(), 0.);
      problem.move_point(11.);
      renew_carriers(problem.tissue);
      EXPECT_EQ(problem.value(), carries ? 0. : 1.);
    }
}


/** The cell is gone: the point takes the nearest one. */
TEST_2D_3D(Carriers, LostCellIsReplaced)
{
  Problem<dim> problem(true);
  renew_carriers(problem.tissue);
  std::vector<unsigned int> first;
  for (unsigned int p = 0; p < problem.tissue.cells().size(); ++p)
    if (problem.tissue.cells().id(p) == 0)
      first.push_back(p);
  problem.tissue.remove(first, {});
  renew_carriers(problem.tissue);
  EXPECT_EQ(problem.value(), 1.);
}


/** Between two cells the mean counts, in any frame, until one is nearer. */
TEST_2D_3D(Carriers, EquallyNearCellsCountAlike)
{
  Problem<dim> problem(true);
  problem.move_point(10.);
  renew_carriers(problem.tissue);
  EXPECT_EQ(problem.value(), 0.5);
  problem.move_point(10.5);
  renew_carriers(problem.tissue);
  EXPECT_EQ(problem.value(), 1.);
}
