// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_gap_watch_h
#define morula_simulation_gap_watch_h

#include <morula/base/announce.h>
#include <morula/grid/spline_space.h>
#include <morula/particles/tissue.h>

#include <optional>

namespace Morula
{
  /** A place at which a surface faces itself. */
  template <int dim>
  struct Gap
  {
    /** The distance between the two boundary points, µm. */
    double width;
    /** The middle between the two boundary points, µm. */
    Point<dim> place;
  };

  /**
   * The narrowest gap of the tissue across which splines reach: two boundary
   * points look at each other through empty space, and their grid cells share
   * unknowns. Two arms of one piece, or the rims of a hole, stick together
   * there. The function returns nothing where there is no such gap. Two points
   * on two ranks count if they are nearer than a grid spacing, since neither
   * rank knows the unknowns of both grid cells. Collective.
   */
  template <int dim>
  std::optional<Gap<dim>>
  narrowest_gap(const Tissue<dim> &tissue, const SplineSpace<dim> &space);

  /** Tells the user of the first gap that narrowest_gap() finds, once a run. */
  template <int dim>
  class GapWatch
  {
  public:
    explicit GapWatch(const Announce &announce);

    /** Looks at the tissue at @p t (day) before every tenth step, the first one
     *  included. Collective. */
    void
    look(const Tissue<dim>      &tissue,
         const SplineSpace<dim> &space,
         const double            t);

  private:
    const Announce announce;
    bool           has_told = false;
    unsigned int   n_looks  = 0;
  };
} // namespace Morula

#endif
