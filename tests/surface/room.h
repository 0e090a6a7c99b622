// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_surface_room_h
#define morula_tests_surface_room_h

#include <morula/surface/cell_surface.h>

#include <deal.II/base/numbers.h>

#include "common/body_on_grid.h"
#include "common/tests.h"

using namespace Morula;

template <int dim>
void
add_cell(const Point<dim> &x, const double V, PointList<dim> &cells)
{
  cells.add(cells.size(), x, ArrayView<const double>(&V, 1));
}

/** Cells of equal volumes. */
template <int dim>
PointList<dim>
cells_at(const std::vector<Point<dim>> &positions, const double l)
{
  PointList<dim> cells(1);
  for (const Point<dim> &x : positions)
    add_cell(x, std::pow(l, dim), cells);
  return cells;
}

/**
 * Cells of a shape on a lattice of cubes of the edge l: each has the volume and
 * the centroid of the part of the shape that is nearest to the center of its
 * cube. Parts of less than an eighth of a cube's edge may be missing.
 */
template <int dim, typename Inside>
PointList<dim>
trimmed(const double l, const double reach, const Inside &inside)
{
  using Index = std::array<int, dim>;
  struct Cube
  {
    Index          index;
    unsigned int   n_inside = 0; // of its corners
    double         volume   = 0.;
    Tensor<1, dim> moment;
  };
  constexpr int           n_samples = 8;
  std::map<Index, Cube *> cells;
  std::vector<Cube>       cubes;
  for (const Point<dim> &x : lattice_points<dim>(reach, l))
    {
      Cube cube;
      for (unsigned int d = 0; d < dim; ++d)
        cube.index[d] = std::floor(x[d] / l);
      for (unsigned int c = 0; c < 1u << dim; ++c)
        {
          Point<dim> corner;
          for (unsigned int d = 0; d < dim; ++d)
            corner[d] = (cube.index[d] + int(c >> d & 1)) * l;
          cube.n_inside += inside(corner);
        }
      cubes.push_back(cube);
    }
  const auto center = [l](const Index &index) {
    Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = (index[d] + 0.5) * l;
    return x;
  };
  for (Cube &cube : cubes)
    if (inside(center(cube.index)))
      cells[cube.index] = &cube;
  const auto nearest = [&](const Index &around, const Point<dim> &x) {
    Cube  *found    = nullptr;
    double distance = std::numeric_limits<double>::max();
    for (int n = 0; n < Utilities::pow(3, dim); ++n)
      {
        Index index = around;
        for (int d = 0, rest = n; d < dim; ++d, rest /= 3)
          index[d] += rest % 3 - 1;
        const auto cell = cells.find(index);
        if (cell != cells.end() && center(index).distance(x) < distance)
          {
            found    = cell->second;
            distance = center(index).distance(x);
          }
      }
    return found;
  };
  for (Cube &cube : cubes)
    if (const bool is_cell = cells.count(cube.index) > 0;
        is_cell && cube.n_inside == 1 << dim)
      {
        cube.volume += std::pow(l, dim);
        cube.moment += std::pow(l, dim) * center(cube.index);
      }
    else if (is_cell || cube.n_inside > 0)
      for (int s = 0; s < Utilities::pow(n_samples, dim); ++s)
        {
          Point<dim> x;
          for (int d = 0, rest = s; d < dim; ++d, rest /= n_samples)
            x[d] = (cube.index[d] + (rest % n_samples + 0.5) / n_samples) * l;
          if (!inside(x))
            continue;
          if (Cube *const cell = is_cell ? &cube : nearest(cube.index, x))
            {
              cell->volume += std::pow(l / n_samples, dim);
              cell->moment += std::pow(l / n_samples, dim) * x;
            }
        }
  PointList<dim> list(1);
  for (const auto &[index, cell] : cells)
    add_cell(Point<dim>(cell->moment / cell->volume), cell->volume, list);
  return list;
}

/** The surface of cells that are all on this rank.
 *  @param grid any box with the spacing and the offset of the grid */
template <int dim>
CellSurface<dim>
surface_of_all_cells(const PointList<dim>  &cells,
                     const GridBox<dim>    &grid,
                     const CellSurfaceWish &wish = CellSurfaceWish())
{
  GridParameters parameters;
  parameters.spacing      = grid.spacing();
  const Point<dim> origin = grid.corner({});
  parameters.offset = std::vector<double>(origin.begin_raw(), origin.end_raw());
  return surface_of_cells(cells,
                          BackgroundGrid<dim>(parameters, MPI_COMM_SELF),
                          wish);
}

template <int dim>
double
total_volume(const PointList<dim> &cells)
{
  return std::accumulate(cells.numbers.begin(), cells.numbers.end(), 0.);
}

#endif
