// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/tangents.h>

namespace Morula
{
  namespace
  {
    /** A tangent is kept as long as each iteration reduces the residual to this
     *  part or less. In 3-D a tangent costs as much as many residuals, so a few
     *  iterations more pay: doc/theory.md, section 5.1. */
    constexpr double sufficient_reduction = 0.2;
    /** A solve that takes more iterations than these is in trouble, and gets a
     *  tangent in each. */
    constexpr unsigned int last_kept_iteration = 10;
  } // namespace

  Tangents::Tangents(Equilibrium &problem, const bool keep)
    : problem(problem)
    , keep(keep)
  {}

  const Equilibrium::Matrix &
  Tangents::at(const Vector &u, const double norm, const bool undisturbed)
  {
    // A tangent is kept only if all signs are good. The first one has the
    // growth of the step's beginning, doc/theory.md (5.1).
    ++n_iterations;
    kept_ = keep && last != nullptr && undisturbed &&
            n_iterations <= last_kept_iteration &&
            norm <= sufficient_reduction * last_norm;
    if (!kept_)
      last = &problem.tangent(u,
                              last == nullptr ? GrowthAt::previous :
                                                GrowthAt::current);
    last_norm = norm;
    return *last;
  }
} // namespace Morula
