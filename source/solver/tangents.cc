// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/tangents.h>

namespace Morula
{
  namespace
  {
    /** Of the residual, with which a tangent still serves. */
    constexpr double sufficient_reduction = 0.2;
    /** Later ones are a sign of trouble. */
    constexpr unsigned int last_kept_iteration = 10;
  } // namespace

  Tangents::Tangents(Equilibrium &problem, const bool keep)
    : problem(problem)
    , keep(keep)
  {}

  const Equilibrium::Matrix &
  Tangents::at(const Vector &u, const double norm, const bool undisturbed)
  {
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

  bool
  Tangents::kept() const
  {
    return kept_;
  }
} // namespace Morula
