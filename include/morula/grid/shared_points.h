// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_grid_shared_points_h
#define morula_grid_shared_points_h

#include <morula/grid/grid_box.h>

#include <array>
#include <cmath>

namespace Morula
{
  /** A point on a grid line, which the grid cells on all its sides share in
   *  equal parts: doc/theory.md, section 2.4. */
  template <int dim>
  class SharedPoint
  {
  public:
    /** A point nearer to a grid line than so many grid spacings counts as on
     * it. This is much more than the error of a step's solution, so that a cell
     *  that should stay on a line does so. */
    static constexpr double on_line = 1e-6;

    SharedPoint(const GridBox<dim> &box, const Point<dim> &x)
    {
      const GridIndex<dim> index = box.locate(x);
      const Point<dim>     xi    = box.unit_position(x, index);
      const Point<dim>     lower = box.corner(index);
      for (unsigned int d = 0; d < dim; ++d)
        {
          sides[d] = {{x[d], x[d]}};
          n[d]     = 1;
          for (const double line : {0., 1.})
            if (std::abs(xi[d] - line) < on_line)
              {
                const double at = lower[d] + line * box.spacing();
                sides[d]        = {
                  {at - on_line * box.spacing(), at + on_line * box.spacing()}};
                n[d] = 2;
              }
        }
    }

    /** Number of grid cells that share the point; 1 for a point on no line. */
    unsigned int
    n_shares() const
    {
      unsigned int product = 1;
      for (const unsigned int n_d : n)
        product *= n_d;
      return product;
    }

    /** Calls @p visit(position) for each of these grid cells. A point on a line
     *  is moved a little, so that its position lies in that grid cell. */
    template <typename Visitor>
    void
    for_each(const Visitor &visit) const
    {
      for (unsigned int share = 0; share < n_shares(); ++share)
        {
          Point<dim>   position;
          unsigned int rest = share;
          for (unsigned int d = 0; d < dim; ++d)
            {
              position[d] = sides[d][rest % n[d]];
              rest /= n[d];
            }
          visit(position);
        }
    }

  private:
    std::array<std::array<double, 2>, dim> sides;
    std::array<unsigned int, dim>          n;
  };
} // namespace Morula

#endif
