// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_direct_solver_h
#define morula_solver_direct_solver_h

#include <morula/mechanics/equilibrium.h>

namespace Morula
{
  /**
   * Solves (K + σ |diag K|) x = b with MUMPS, or KLU where Trilinos lacks it,
   * with the smallest tried σ that gives a direction of descent.
   * @param iterations in/out: the factorisations are added
   * @param largest_shift in/out: raised to the largest σ at which the tangent
   *                      was still indefinite
   * @throws StepFailed on all ranks together
   */
  void
  solve_direct(const Equilibrium::Matrix &K,
               const LinearProblem       &problem,
               Equilibrium::Vector       &x,
               const Equilibrium::Vector &b,
               unsigned int              &iterations,
               double                    &largest_shift);
} // namespace Morula

#endif
