// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_tests_voronoi_dividing_tissue_h
#define morula_tests_voronoi_dividing_tissue_h

#include <morula/effects/division/divide.h>

#include <deal.II/base/bounding_box.h>

#include "common/tests.h"


namespace Morula
{
  using Distances = std::array<double, 2>;

  constexpr double infinity = std::numeric_limits<double>::infinity();

  /** Cells, those that divide, and Dirichlet walls. */
  template <int dim>
  struct DividingTissue
  {
    std::vector<Point<dim>>            positions;
    std::vector<types::particle_index> ids;
    std::vector<DividingCell<dim>>     dividing;
    std::vector<WallPoint<dim>>        walls;

    explicit DividingTissue(const std::vector<Point<dim>> &positions)
      : positions(positions)
      , ids(positions.size())
    {
      std::iota(ids.begin(), ids.end(), 1000);
    }

    void
    divide(const std::size_t i, const Tensor<1, dim> &axis, const double length)
    {
      dividing.push_back({ids[i], positions[i], axis / axis.norm(), length});
    }

    /** @param h of the grid that cells and walls are searched on */
    std::vector<Distances>
    distances(const double h = 1.) const
    {
      std::vector<Point<dim>> all = positions;
      for (const auto &wall : walls)
        all.push_back(wall.position);
      const BoundingBox<dim> bounds(all);
      GridIndex<dim>         first, n;
      for (unsigned int d = 0; d < dim; ++d)
        {
          first[d] = std::floor(bounds.lower_bound(d) / h);
          n[d]     = std::floor(bounds.upper_bound(d) / h) + 1 - first[d];
        }
      return daughter_distances(dividing,
                                ids,
                                positions,
                                walls,
                                GridBox<dim>(first, n, h, Point<dim>()));
    }
  };

  /** Uniform on the unit sphere. */
  template <int dim>
  Tensor<1, dim>
  random_axis(std::mt19937 &generator)
  {
    std::normal_distribution<double> normal;
    Tensor<1, dim>                   axis;
    for (unsigned int d = 0; d < dim; ++d)
      axis[d] = normal(generator);
    return axis / axis.norm();
  }

  /** Uniform in the cube from the origin to @p size. */
  template <int dim>
  Point<dim>
  random_point(std::mt19937 &generator, const double size)
  {
    std::uniform_real_distribution<double> uniform(0., size);
    Point<dim>                             p;
    for (unsigned int d = 0; d < dim; ++d)
      p[d] = uniform(generator);
    return p;
  }

  /** The regular lattice of unit spacing with n^dim points. */
  template <int dim>
  std::vector<Point<dim>>
  lattice(const unsigned int n)
  {
    std::vector<Point<dim>> points;
    for (unsigned int i = 0; i < std::pow(n, dim) - 0.5; ++i)
      {
        Point<dim> p;
        for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
          p[d] = rest % n;
        points.push_back(p);
      }
    return points;
  }
} // namespace Morula

#endif
