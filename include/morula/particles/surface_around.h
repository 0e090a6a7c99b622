// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_particles_surface_around_h
#define morula_particles_surface_around_h

#include <morula/grid/grid_box.h>
#include <morula/particles/tissue.h>

#include <memory>
#include <vector>

namespace Morula
{
  /** Where the surface of the tissue is, to be asked near this rank's cells. */
  template <int dim>
  class SurfaceAround
  {
  public:
    /** Looks at the boundary points of the tissue, on any rank, within @p reach
     *  (µm) of this rank's grid cells. Collective. */
    SurfaceAround(const Tissue<dim> &tissue, const double reach);

    /** Midway, the same bits for both orders. */
    static Point<dim>
    middle(const Point<dim> &x, const Point<dim> &y)
    {
      Point<dim> found;
      for (unsigned int d = 0; d < dim; ++d)
        found[d] = 0.5 * (x[d] + y[d]);
      return found;
    }

    /** Whether a boundary point is that near to a place, which may look no
     *  farther than the reach of a grid cell of this rank. Radius in µm. */
    bool
    is_within(const Point<dim> &x, const double radius) const;

    /** Whether the surface passes between two places, one of which is in a grid
     *  cell of this rank: a boundary point lies in the ball that has them at
     *  its ends. In full tissue there is none; across a gap, and outside of a
     *  concave surface, there are some, as long as boundary points stand no
     *  farther apart than cells do. */
    bool
    is_between(const Point<dim> &x, const Point<dim> &y) const
    {
      return is_within(middle(x, y), 0.5 * x.distance(y));
    }

  private:
    std::vector<Point<dim>> points;
    /** They refer to the points; none without points. */
    std::unique_ptr<const GridBox<dim>>   box;
    std::unique_ptr<const PointBins<dim>> bins;
  };

  /** A box of grid cells of the edge @p spacing (µm) around @p positions, of
   *  which there is at least one. */
  template <int dim>
  GridBox<dim>
  box_around(const std::vector<Point<dim>> &positions, const double spacing);
} // namespace Morula

#endif
