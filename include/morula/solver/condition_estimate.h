// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_condition_estimate_h
#define morula_solver_condition_estimate_h

#include <morula/mechanics/equilibrium.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace Morula
{
  /**
   * The extreme eigenvalues of a tangent K scaled to a unit diagonal,
   * D^(-1/2) K D^(-1/2), among the displacements that the problem determines:
   * doc/theory.md (5.5).
   */
  struct ConditionEstimate
  {
    std::uint64_t unknowns = 0;
    double        smallest = 0.; // negative: K is indefinite
    double        largest  = 0.;

    /** Their ratio, at most 1/ε: beyond that a matrix cannot be told from a
     *  singular one. An indefinite matrix has that value, too. */
    double
    condition() const
    {
      const double least =
        std::numeric_limits<double>::epsilon() * std::abs(largest);
      return largest > 0. ? largest / std::max(smallest, least) :
                            1. / std::numeric_limits<double>::epsilon();
    }
  };

  /**
   * Estimates the condition of the first tangent of a step, which Newton's
   * method takes at the growth of the step's beginning. Of an unsymmetric one
   * (following pressure) the symmetric part counts. Assembles the tangent anew.
   * Collective.
   * @param rest u = 0, in the layout of the unknowns
   */
  ConditionEstimate
  estimate_condition(Equilibrium               &problem,
                     const LinearProblem       &linear_problem,
                     const Equilibrium::Vector &rest);
} // namespace Morula

#endif
