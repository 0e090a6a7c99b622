// ranks: 1 2
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/particles/even_spread.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/body_on_grid.h"
#include "particles/random_points.h"

using namespace Morula;

namespace
{
  constexpr double length = 10.; // of cells, um
  constexpr int    n      = 8;   // of them along an edge
  constexpr double edge   = n * length;

  /** A box of cells in its surface, from the origin on. The half at small x
   *  has @p overlap of its own volume too much, the other half too little. */
  template <int dim>
  void
  place(Tissue<dim> &tissue, const double overlap)
  {
    const CellColumns<dim>     columns;
    const BoundaryColumns<dim> boundary_columns;
    PointList<dim>             cells(columns.n_numbers());
    PointList<dim>             surface(boundary_columns.n_numbers());
    const auto                 squeezed = [overlap](const double x) {
      const double middle = 0.5 * edge;
      return x < middle ?
                               x * (1. - overlap) :
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
        cells.add(i,
                  x,
                  make_array_view(
                    columns.founder(x, Utilities::fixed_power<dim>(length))));
      }
    tissue.place(dealt(cells), dealt(surface));
  }

  template <int dim>
  GridParameters
  grid()
  {
    GridParameters parameters;
    parameters.spacing = 25.;
    return parameters;
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
    return {{Utilities::MPI::sum(sum, MPI_COMM_WORLD) / Utilities::pow(n, dim),
             Utilities::MPI::min(depth, MPI_COMM_WORLD)}};
  }

  /** Whether kernels at a place reach one face of the box at most. */
  template <int dim>
  bool
  sees_one_face(const Point<dim> &x)
  {
    unsigned int n_faces = 0;
    for (unsigned int d = 0; d < dim; ++d)
      n_faces += std::min(x[d], edge - x[d]) < 2.6 * length;
    return n_faces <= 1;
  }

  /** Cells that fill their body evenly stay, but for those along its edges,
   *  where two faces meet. Others move until their centre is
   *  that of the body, and no farther; none leaves it. */
  template <int dim>
  void
  check()
  {
    Tissue<dim> even(grid<dim>(), CellColumns<dim>(), MPI_COMM_WORLD);
    place(even, 0.);
    spread_cells(even, 0.125);
    EXPECT_NEAR(middle_and_depth(even)[0], 0.5 * edge, 1e-9);
    for (unsigned int p = 0; p < even.cells().size(); ++p)
      {
        if (!sees_one_face(even.cells().founder_position(p)))
          continue;
        EXPECT_LT(even.cells().position(p).distance(
                    even.cells().founder_position(p)),
                  0.02 * length);
      }

    Tissue<dim> uneven(grid<dim>(), CellColumns<dim>(), MPI_COMM_WORLD);
    place(uneven, 0.2);
    const double before = middle_and_depth(uneven)[0] - 0.5 * edge;
    EXPECT_NEAR(before, -0.05 * edge, 1e-9);
    for (unsigned int step = 0; step < 60; ++step)
      {
        spread_cells(uneven, 0.125);
        EXPECT_GT(middle_and_depth(uneven)[1], 0.2 * length);
      }
    EXPECT_LT(std::abs(middle_and_depth(uneven)[0] - 0.5 * edge),
              0.2 * std::abs(before));
    for (unsigned int p = 0; p < uneven.cells().size(); ++p)
      EXPECT_EQ(uneven.cells().volume(p), Utilities::fixed_power<dim>(length));
  }
} // namespace

TEST(EvenSpread, FillsTheBody)
{
  MORULA_BOTH_DIMENSIONS(check)
}
