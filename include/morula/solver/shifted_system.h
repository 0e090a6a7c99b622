// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_shifted_system_h
#define morula_solver_shifted_system_h

#include <morula/solver/halo_product.h>
#include <morula/solver/null_space.h>
#include <morula/solver/preconditioner.h>

#include <vector>

namespace Morula
{
  /** How conjugate gradients have ended. */
  enum class CgOutcome
  {
    converged,
    negative_curvature,
    indefinite_preconditioner,
    stalled // more than the iterations allowed
  };

  /** The system (K + σ |diag K|) x = b, in the space orthogonal to a null
   *  space. */
  struct ShiftedSystem
  {
    const HaloProduct                      &K;
    const std::vector<Equilibrium::Vector> &null_space;
    double                                  shift; // σ
    /** What K lacks, or null. */
    const Equilibrium::RankOne *rank_one = nullptr;
  };
} // namespace Morula

#endif
