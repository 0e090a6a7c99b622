// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_nox_convergence_h
#define morula_solver_nox_convergence_h

#include <morula/solver/newton.h>
#include <morula/solver/tangents.h>

#include <NOX_StatusTest_Generic.H>

#include <limits>
#include <ostream>
#include <string>

namespace Morula
{
  /**
   * Converged where both the unbalanced forces and what they may still move are
   * below their bounds, doc/theory.md (5.3). Failed where Newton's method no
   * longer gets on: its last iterations have brought neither a new lowest
   * energy nor a new lowest residual. Notes the states down if the report wants
   * them.
   */
  class ConvergenceTest : public NOX::StatusTest::Generic
  {
  public:
    /** Where the method ends. */
    struct Bounds
    {
      double       residual;     // kPa µm^(dim-1)
      double       rounding;     // of the residual: below it nothing is asked
      double       displacement; // µm
      unsigned int iterations;
    };

    /** @param has_energy whether a lower energy counts as progress
     *  @param report     kept as a reference, as are the tangents */
    ConvergenceTest(const Bounds   &bounds,
                    const Tangents &tangents,
                    const bool      has_energy,
                    NewtonReport   &report);

    NOX::StatusTest::StatusType
    checkStatus(const NOX::Solver::Generic &solver,
                NOX::StatusTest::CheckType) override;

    /** Why it has failed; also where the line search has. */
    const std::string &
    reason_of_failure() const;

    NOX::StatusTest::StatusType
    getStatus() const override;

    std::ostream &
    print(std::ostream &stream, int) const override;

  private:
    /** The last change of the solution times the ratio by which the residual
     *  became smaller, in the maximum norm, µm: doc/theory.md (5.3). Once the
     *  residual has grown in an iteration, it says nothing of the motion that
     *  is left: then the change itself. Infinite where the iteration has
     *  changed nothing. */
    double
    left_over(const NOX::Solver::Generic &solver) const;

    /** Takes the present state into account: its energy and residual. */
    void
    look(const NOX::Solver::Generic &solver);

    const Bounds    bounds;
    const Tangents &tangents;
    const bool      has_energy;
    NewtonReport   &report;
    double          last_norm   = std::numeric_limits<double>::infinity();
    double          lowest_norm = // that counted as progress, N
      std::numeric_limits<double>::infinity();
    double      lowest_energy = std::numeric_limits<double>::infinity();
    int         progress_at   = 0;     // the iteration that brought the lowest
    bool        has_risen     = false; // the residual, in any iteration
    std::string reason        = "no part of Newton's step has a lower energy";
    NOX::StatusTest::StatusType status = NOX::StatusTest::Unevaluated;
  };
} // namespace Morula

#endif
