// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_tangents_h
#define morula_solver_tangents_h

#include <morula/mechanics/equilibrium.h>

namespace Morula
{
  /**
   * The tangents of one solve. A tangent costs several residuals, and its
   * linear systems are solved loosely as long as the residual is large: so an
   * iteration goes on with the last tangent while that makes the residual five
   * times smaller (doc/theory.md, 5.1).
   */
  class Tangents
  {
  public:
    using Vector = Equilibrium::Vector;
    using Matrix = Equilibrium::Matrix;

    /**
     * @param problem kept as a reference
     * @param keep    whether one may serve several iterations
     */
    Tangents(Equilibrium &problem, const bool keep);

    /**
     * The tangent for an iteration from @p u on, the last one or a new one; the
     * first is taken at the growth of the step's beginning. Collective.
     * @param norm of the residual at u, kPa µm^(dim-1)
     * @param undisturbed whether the last iteration took its whole step, and
     *        no tangent has been indefinite so far
     */
    const Matrix &
    at(const Vector &u, const double norm, const bool undisturbed);

    /** Whether at() has returned the same matrix once more. */
    bool
    kept() const
    {
      return kept_;
    }

  private:
    Equilibrium  &problem;
    const bool    keep;
    const Matrix *last         = nullptr;
    bool          kept_        = false;
    double        last_norm    = 0.;
    unsigned int  n_iterations = 0;
  };
} // namespace Morula

#endif
