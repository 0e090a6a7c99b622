// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_step_error_h
#define morula_simulation_step_error_h

#include <morula/particles/tissue.h>

#include <functional>

namespace Morula
{
  /** The estimate of a run's error in time: doc/theory.md (5.10). */
  struct ErrorInTime
  {
    /** What the last step missed of flow, relative to the volume. It is known
     * at the step's end, while what is missed of growth is known only when the
     *  next step begins. */
    double flow = 0.;
    /** μ of the step before the last. */
    double last = 0.;
    /** The sum of |μ_{n+1} - μ_n| / 6. */
    double changes = 0.;

    /** Adds μ of a step. */
    void
    add(const double mu);

    /** The error of the whole run, E of (5.10): relative, as a volume or a
     *  strain. */
    double
    total() const
    {
      return changes + last;
    }
  };

  /**
   * The mean of a number of each cell over the tissue's volume. The sums are
   * those of integers, so that the mean is the same for any number of ranks: it
   * decides how long steps are. Collective.
   * @param number not negative; above 1 it counts as 1
   * @param scale  a typical volume of a cell, µm^dim
   */
  template <int dim>
  double
  mean_over_tissue(const Tissue<dim>                               &tissue,
                   const std::function<double(const unsigned int)> &number,
                   const double                                     scale);
} // namespace Morula

#endif
