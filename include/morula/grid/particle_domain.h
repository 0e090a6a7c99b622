// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_particle_domain_h
#define morula_grid_particle_domain_h

#include <deal.II/base/point.h>

#include <algorithm>
#include <cmath>

namespace Morula
{
  using namespace dealii;

  /**
   * The axis-parallel box of side V^(1/dim) that a particle occupies, and the
   * quadrature points in it: one in the middle, or a regular n^dim of them
   * where the scene asks for it or the box is larger than half a grid cell.
   * Without these, a full grid cell could hold no point at all.
   */
  template <int dim>
  class ParticleDomain
  {
  public:
    /**
     * @param x position, µm
     * @param V current volume, µm^dim
     */
    ParticleDomain(const Point<dim> &x, const double V)
      : x(x)
      , side(std::pow(V, 1. / dim))
    {}

    Point<dim>
    lower() const
    {
      return corner(-0.5);
    }

    Point<dim>
    upper() const
    {
      return corner(0.5);
    }

    /** Quadrature points per direction, at least @p least, on a grid of
     *  spacing @p h (µm): doc/theory.md (2.2). */
    unsigned int
    n_per_direction(const double h, const unsigned int least) const
    {
      return std::max(least,
                      static_cast<unsigned int>(
                        std::ceil(std::max(2. * side / h - 1e-9, 1e-9))));
    }

    /** Calls @p visit(position) for all n^dim points, x fastest. */
    template <typename Visitor>
    void
    for_quadrature_points(const unsigned int n, const Visitor &visit) const
    {
      unsigned int n_points = 1;
      for (unsigned int d = 0; d < dim; ++d)
        n_points *= n;
      for (unsigned int q = 0; q < n_points; ++q)
        {
          Point<dim>   point = x;
          unsigned int rest  = q;
          for (unsigned int d = 0; d < dim; ++d, rest /= n)
            point[d] += side * ((rest % n + 0.5) / n - 0.5);
          visit(point);
        }
    }

  private:
    Point<dim>
    corner(const double part) const
    {
      Point<dim> point = x;
      for (unsigned int d = 0; d < dim; ++d)
        point[d] += part * side;
      return point;
    }

    const Point<dim> x;
    const double     side;
  };
} // namespace Morula

#endif
