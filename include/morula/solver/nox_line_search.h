// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_nox_line_search_h
#define morula_solver_nox_line_search_h

#include <morula/mechanics/equilibrium.h>

#include <NOX_LineSearch_Generic.H>

#include <deque>

namespace Morula
{
  /**
   * Backtracking on the energy with Armijo's rule and slack for rounding,
   * doc/theory.md (5.2); for problems without energy, on |R|. Inversion counts
   * as infinite energy. The direction of a kept tangent is taken as a whole, if
   * it makes |R| smaller as well, or not at all: then the next iteration has a
   * tangent of its own.
   *
   * The energy may rise for some iterations: it is compared with the largest of
   * the last ten states of this solve (Grippo, Lampariello and Lucidi, 1986).
   * A soft motion, such as a fold's, that follows a curved stiff path would
   * otherwise be cut to a small part of itself in every other iteration. The
   * state where the solve starts does not count: its energy, with the growth of
   * the whole step, would admit anything.
   */
  class EnergyLineSearch : public NOX::LineSearch::Generic
  {
  public:
    EnergyLineSearch(const Equilibrium &problem, const bool has_energy);

    bool
    compute(NOX::Abstract::Group        &group,
            double                      &step,
            const NOX::Abstract::Vector &direction,
            const NOX::Solver::Generic  &solver) override;

  private:
    /** The energy that the next state is compared with, given that of the
     *  @p present one. */
    double
    reference(const double present);

    const Equilibrium &problem;
    const bool         has_energy;
    bool               has_begun = false;
    std::deque<double> accepted; // the last energies, without the first
  };
} // namespace Morula

#endif
