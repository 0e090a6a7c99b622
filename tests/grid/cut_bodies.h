// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_grid_cut_bodies_h
#define morula_tests_grid_cut_bodies_h

#include <cmath>
#include <random>
#include <vector>

#include "common/body_on_grid.h"

namespace Morula
{
  /** Of the grid of body(), µm. */
  constexpr double h = 50.;

  /** Of its cells, µm. */
  template <int dim>
  double
  cell_spacing()
  {
    return dim == 2 ? h / 6. : h / 3.5;
  }

  /** A ball cut by a half space: any cut, one piece with inner grid cells. */
  template <int dim>
  std::vector<Point<dim>>
  random_body(const unsigned int seed)
  {
    std::mt19937                           generator(seed);
    std::uniform_real_distribution<double> uniform(0., 1.);
    const double radius = h * (2. + 0.8 * uniform(generator));
    const double spacing =
      cell_spacing<dim>() * (1. + 0.3 * uniform(generator));
    const Point<dim> center(2. * h * random_tensor<1, dim>(generator));
    Tensor<1, dim>   normal = random_tensor<1, dim>(generator);
    normal /= normal.norm();
    const double cut = radius * 0.8 * uniform(generator);
    return lattice_points<dim>(center, radius, spacing, [&](const auto &x) {
      return x.distance(center) < radius && normal * (x - center) < cut;
    });
  }

  /** The body with these cells. */
  template <int dim>
  BodyOnGrid<dim>
  body(const std::vector<Point<dim>> &points,
       const MPI_Comm                 comm = MPI_COMM_WORLD)
  {
    return BodyOnGrid<dim>(
      points, std::pow(cell_spacing<dim>(), dim), GridParameters(), {}, comm);
  }
} // namespace Morula

#endif
