// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/nox_group.h>
#include <morula/solver/nox_line_search.h>

#include <NOX_Solver_Generic.H>

#include <algorithm>
#include <cmath>

namespace Morula
{
  namespace
  {
    /** The number of energies of which the largest counts. With three instead
     *  of ten, folding rings took half as many iterations again. */
    constexpr unsigned int memory = 10;
  } // namespace


  EnergyLineSearch::EnergyLineSearch(const Equilibrium &problem,
                                     const bool         has_energy)
    : problem(problem)
    , has_energy(has_energy)
  {}


  double
  EnergyLineSearch::reference(const double present)
  {
    // The state where a solve starts has the growth of the whole step, and so
    // an energy that would admit anything: it is compared with, once, but not
    // remembered.
    if (!has_begun)
      {
        has_begun = true;
        return present;
      }
    accepted.push_back(present);
    if (accepted.size() > memory)
      accepted.pop_front();
    return *std::max_element(accepted.begin(), accepted.end());
  }


  // The whole direction is tried, then halves of it. A part is accepted if the
  // energy there is low enough, doc/theory.md (5.2), or, without an energy, if
  // |R| is. An inverted state has an infinite energy, so it is halved away like
  // any other. The direction of a kept tangent may be none of descent, so it is
  // not worth halving: it is taken as a whole, or refused by a step of length
  // 0, after which the next iteration has a tangent of its own.
  bool
  EnergyLineSearch::compute(NOX::Abstract::Group        &group,
                            double                      &step,
                            const NOX::Abstract::Vector &direction,
                            const NOX::Solver::Generic  &solver)
  {
    // Armijo's constant has its usual value. After 30 halvings a step is 10⁻⁹
    // of the direction.
    constexpr double       armijo         = 1e-4;
    constexpr unsigned int max_reductions = 30;
    const auto            &old_group =
      dynamic_cast<const NoxGroup &>(solver.getPreviousSolutionGroup());
    auto &new_group = dynamic_cast<NoxGroup &>(group);

    const bool   is_kept  = old_group.has_kept_tangent();
    const double slope    = direction.innerProduct(old_group.getF());
    const auto  &before   = old_group.evaluation();
    const double slack    = rounding_error * before.energy_magnitude;
    const double compared = reference(before.energy);
    step                  = 1.;
    for (unsigned int i = 0; i < max_reductions; ++i, step *= 0.5)
      {
        new_group.computeX(old_group, direction, step);
        new_group.computeF();
        const double energy = new_group.evaluation().energy;
        const double norm   = new_group.getNormF();
        const bool falls = norm <= (1. - armijo * step) * old_group.getNormF();
        if (std::isfinite(energy) &&
            (!is_kept || norm <= old_group.getNormF()) &&
            (has_energy ?
               energy <= compared + armijo * step * slope + slack :
               falls ||
                 norm <=
                   rounding_of_residual(problem, values_of(new_group.getX()))))
          return true;
        // A step of length 0 counts as a success for NOX, which goes on from
        // the old state.
        if (is_kept)
          {
            step = 0.;
            new_group.computeX(old_group, direction, step);
            new_group.computeF();
            return true;
          }
      }
    step = 0.; // any other length NOX would take for a recovery step
    return false;
  }
} // namespace Morula
