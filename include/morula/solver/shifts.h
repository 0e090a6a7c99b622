// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_shifts_h
#define morula_solver_shifts_h

namespace Morula
{
  /**
   * Shifts σ tried on negative curvature, doc/theory.md (5.4): each at least
   * factor times the one before, and curvature_factor times what the curvature
   * asks for (the direct solver knows no curvature and begins with first).
   * Where a body buckles the curvature is tiny, and a shift much larger than it
   * would let Newton's method leave the straight state by a thousandth an
   * iteration.
   */
  namespace Shifts
  {
    constexpr double first            = 1e-3;
    constexpr double least            = 1e-9;
    constexpr double factor           = 4.;
    constexpr double curvature_factor = 2.;
    constexpr double last             = 300.;
    /** From this shift on the diagonal prevails: Jacobi's preconditioner, which
     *  knows the shift, takes fewer iterations than a factorisation that does
     *  not. */
    constexpr double for_jacobi = 1.;
  } // namespace Shifts
} // namespace Morula

#endif
