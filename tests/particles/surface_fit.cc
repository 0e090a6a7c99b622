// ranks: 1 3
// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include "particles/room.h"

constexpr double length = 10.; // of cells, um

/** A cube of cells, and the middle of a patch above each that is outermost;
 *  one of the patches stands off from the cells. */
template <int dim>
class Cube
{
public:
  explicit Cube(const double stands_off)
    : cells(cells_at(lattice_points<dim>(40., length),
                     Utilities::fixed_power<dim>(length)))
    , surface(BoundaryColumns<dim>().n_numbers())
    , tissue(grid_of_spacing(25.), CellColumns<dim>(), MPI_COMM_WORLD)
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        const auto &all = cells.positions;
        const auto  low = [d](const auto &a, const auto &b) {
          return a[d] < b[d];
        };
        const double first =
          (*std::min_element(all.begin(), all.end(), low))[d];
        const double last = (*std::max_element(all.begin(), all.end(), low))[d];
        for (const Point<dim> &x : all)
          for (const double sign : {-1., 1.})
            if (x[d] == (sign < 0. ? first : last))
              {
                Tensor<1, dim> n;
                n[d] = sign;
                add(Point<dim>(x + 0.5 * length * n), n);
              }
      }
    surface.positions[0] = surface.positions[0] + stands_off * normal(0);
    tissue.place(dealt(cells), dealt(surface));
  }


  Tensor<1, dim>
  normal(const std::size_t i) const
  {
    return BoundaryView<dim>(ArrayView<const double>(surface.row(i)), columns)
      .initial_normal();
  }

  PointList<dim>             cells, surface;
  const BoundaryColumns<dim> columns;
  Tissue<dim>                tissue;

private:
  void
  add(const Point<dim> &x, const Tensor<1, dim> &n)
  {
    surface.add(surface.size(),
                x,
                make_array_view(BoundaryColumns<dim>().initial_point(
                  x,
                  n,
                  Utilities::fixed_power<dim - 1>(length),
                  SurfaceCondition::free)));
  }
};


TEST_2D_3D(SurfaceFit, IsThatOfACube)
{
  for (const double way : {0., 3., 20., 90.})
    {
      SCOPED_TRACE(way);
      Cube<dim>        cube(way);
      const SurfaceFit fit = surface_fit(cube.tissue);
      const double     V   = Utilities::fixed_power<dim>(length);
      EXPECT_NEAR(fit.distance, 0.5 * length + way, 1e-10);
      EXPECT_NEAR(fit.cells, cube.cells.size() * V, 1e-6 * V);
      EXPECT_NEAR(fit.enclosed, fit.cells + way * V / length / dim, 1e-6 * V);
      EXPECT_LT(fit.opening, 1e-12);
    }
}
