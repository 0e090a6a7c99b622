// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors
// ranks: 1 3

#include "particles/room.h"

/** A body of cells on a lattice that its surface cuts: each cell has the volume
 *  and the centroid of its part. A box, or a ball. */
template <int dim>
struct Body
{
  const CellColumns<dim>     columns;
  const BoundaryColumns<dim> of_points;
  PointList<dim>             cells, patches;

  /** @param size half the edge, or the radius, um
   *  @param l    lattice constant, um
   *  @param fill by which volumes are too large */
  Body(const bool        is_box,
       const double      size,
       const double      l,
       const Point<dim> &middle,
       const double      fill)
    : cells(columns.n_numbers())
    , patches(of_points.n_numbers())
  {
    constexpr int fine      = dim == 2 ? 8 : 4;
    const int     n         = static_cast<int>(size / l) + 1;
    const auto    is_inside = [&](const Tensor<1, dim> &x) {
      double farthest = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        farthest = std::max(farthest, std::abs(x[d]));
      return (is_box ? farthest : x.norm()) < size;
    };
    for_grid(2 * n, [&](const std::array<int, dim> &i) {
      Tensor<1, dim> sum;
      double         count = 0.;
      for_grid(fine, [&](const std::array<int, dim> &k) {
        Tensor<1, dim> x;
        for (unsigned int d = 0; d < dim; ++d)
          x[d] = (i[d] - n + (k[d] + 0.5) / fine) * l;
        if (is_inside(x))
          {
            sum += x;
            count += 1.;
          }
      });
      if (count > 0.)
        cells.add(cells.size(),
                  middle + sum / count,
                  columns.founder(middle + sum / count,
                                  fill * count *
                                    Utilities::fixed_power<dim>(l / fine)));
    });
    is_box ? add_faces(size, middle) : add_sphere(size, middle);
  }

private:
  template <typename Visit>
  static void
  for_grid(const int n, const Visit &visit)
  {
    for (int number = 0; number < static_cast<int>(Utilities::pow(n, dim));
         ++number)
      {
        std::array<int, dim> i;
        for (int d = 0, rest = number; d < dim; ++d, rest /= n)
          i[d] = rest % n;
        visit(i);
      }
  }

  void
  add(const Point<dim> &x, const Tensor<1, dim> &normal, const double area)
  {
    patches.add(patches.size(),
                x,
                make_array_view(of_points.initial_point(
                  x, normal / normal.norm(), area, SurfaceCondition::free)));
  }

  void
  add_faces(const double size, const Point<dim> &middle)
  {
    const int    n = 24;
    const double a = 2. * size / n;
    for_grid(n, [&](const std::array<int, dim> &i) {
      for (unsigned int face = 0; face < dim; ++face)
        for (const double side : {-1., 1.})
          if (i[face] == 0)
            {
              Tensor<1, dim> x, normal;
              for (unsigned int d = 0; d < dim; ++d)
                x[d] = -size + (i[d] + 0.5) * a;
              x[face]      = side * size;
              normal[face] = side;
              add(middle + x, normal, Utilities::fixed_power<dim - 1>(a));
            }
    });
  }

  void
  add_sphere(const double R, const Point<dim> &middle)
  {
    const int    n      = dim == 2 ? 120 : 1500;
    const double golden = numbers::PI * (3. - std::sqrt(5.));
    for (int k = 0; k < n; ++k)
      {
        Tensor<1, dim> normal;
        const double   z     = dim == 2 ? 0. : 1. - (2. * k + 1.) / n;
        const double   angle = dim == 2 ? 2. * numbers::PI * k / n : golden * k;
        normal[dim - 1]      = z;
        normal[0] += std::sqrt(1. - z * z) * std::cos(angle);
        normal[1] += std::sqrt(1. - z * z) * std::sin(angle);
        add(middle + R * normal,
            normal,
            (dim == 2 ? 2. * R : 4. * R * R) * numbers::PI / n);
      }
  }
};

// Cells that fill a body have φ = 1, wherever the grid lies, and others what
// they have too much; the same on any number of ranks.
TEST_2D_3D(SpaceOfCells, FillsBodies)
{
  for (const bool is_box : {true, false})
    for (const double offset : {0., 0.31})
      for (const double fill : {1., 1.2})
        {
          const double l = 10., h = 30., size = 100.;
          Point<dim>   middle;
          for (unsigned int d = 0; d < dim; ++d)
            middle[d] = offset * h * (d + 1.);
          const Body<dim> body(is_box, size, l, middle, fill);
          Tissue<dim> tissue(grid_of_spacing(h), body.columns, MPI_COMM_WORLD),
            alone(grid_of_spacing(h), body.columns, MPI_COMM_SELF);
          tissue.place(dealt(body.cells), dealt(body.patches));
          alone.place(body.cells, body.patches);
          const SpaceOfCells space = space_of_cells(tissue),
                             other = space_of_cells(alone);
          std::map<types::particle_index, double> fills;
          for (unsigned int p = 0; p < alone.cells().size(); ++p)
            fills[alone.cells().id(p)] = other.fill[p];
          for (unsigned int p = 0; p < tissue.cells().size(); ++p)
            {
              const double distance =
                tissue.cells().position(p).distance(middle);
              EXPECT_EQ(space.fill[p], fills.at(tissue.cells().id(p)));
              EXPECT_NEAR(space.fill[p] / fill, 1., 0.02);
              EXPECT_LE(space.inside[p], 1.);
              EXPECT_GT(space.inside[p], 0.15);
              if (distance < size - 3. * h - 5.)
                {
                  EXPECT_NEAR(space.fill[p], fill, 1e-5);
                  EXPECT_NEAR(space.inside[p], 1., 1e-5);
                }
            }
        }
}
