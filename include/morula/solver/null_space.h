// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_null_space_h
#define morula_solver_null_space_h

#include <morula/mechanics/equilibrium.h>

#include <vector>

namespace Morula
{
  /** Removes the parts of @p x along orthonormal @p directions. */
  inline void
  remove_parts(Equilibrium::Vector                    &x,
               const std::vector<Equilibrium::Vector> &directions)
  {
    for (const Equilibrium::Vector &direction : directions)
      x.add(-(x * direction), direction);
  }

  /** Adds what the rank-one part of a tangent (null: none) makes of @p x. */
  inline void
  add_rank_one(Equilibrium::Vector        &y,
               const Equilibrium::RankOne *part,
               const Equilibrium::Vector  &x)
  {
    if (part != nullptr)
      y.add(part->factor * (part->b * x), part->b);
  }
} // namespace Morula

#endif
