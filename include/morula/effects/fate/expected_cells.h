// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_expected_cells_h
#define morula_effects_fate_expected_cells_h

#include <morula/effects/fate/cell_cycle.h>

#include <deal.II/base/point.h>

#include <utility>

namespace Morula
{
  /**
   * Expected number of cells at time @p t, day, that descend from one which
   * waits in G0 at t = 0, or enters S then if all start @p together: 1 + sum
   * over k of 2^(k-1) times the probability that k waits, exponential with the
   * rate @p Lambda, 1/day, and k - 1/2 cycles of duration @p T, day, fit in.
   */
  double
  expected_cells(const double T,
                 const double Lambda,
                 const double t,
                 const bool   together);

  /**
   * Expected number of cells that descend from one which divides by size, when
   * the volume of all of them together is @p ratio times the mean of the
   * volume at which cells divide, and @p noise its coefficient of variation:
   * doc/theory.md (6.10). Death is not in it.
   */
  double
  expected_cells_by_size(const double ratio, const double noise);

  /** How many descendants the founders of a scene with a cell cycle have at
   *  its end, on average. */
  template <int dim>
  class Descendants
  {
  public:
    /** Counts descendants until @p end_time, day. */
    Descendants(const CellCycleParameters &cycle, const double end_time);

    /**
     * The number for a founder at @p X, the founder included. With a size
     * checkpoint, or expressions that depend on the cells' state, it is 1: a
     * lower bound, since only the run shows more.
     * @throws InputError if an expression has no value
     */
    double
    expected(const Point<dim> &X);

  private:
    const bool   together;
    const double end_time;
    // most founders are like the one before
    std::pair<double, double> last = {-1., -1.};
    double                    n    = 1.;
    Expression                where, duration, rate, checkpoint;
  };
} // namespace Morula

#endif
