// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_turns_h
#define morula_solver_turns_h

#include <morula/solver/newton.h>

#include <functional>
#include <string>
#include <vector>

namespace Morula
{
  /**
   * Something that an equilibrium holds fixed while it is found, and that is
   * renewed after it, such as the pressure of a lumen that keeps its volume:
   * doc/theory.md (5.6).
   */
  class TurnParticipant
  {
  public:
    virtual ~TurnParticipant() = default;

    /**
     * Renews what was held fixed. Collective.
     * @param u the equilibrium that was found, µm
     * @return whether another turn is needed
     * @throws StepFailed where it cannot be renewed
     */
    virtual bool
    renew(const Equilibrium::Vector &u) = 0;

    /** What is still wrong after the last turn, for the message of a step that
     *  fails by it. */
    virtual std::string
    unfinished() const = 0;
  };

  /**
   * The equilibrium of a step in turns: solves, asks every participant to renew
   * what it holds fixed, and solves again from there, until none needs another
   * turn. Collective.
   * @param solve  finds the displacement @p u at which the problem is balanced
   * @param report in/out: counts the turns
   * @throws StepFailed after twenty turns
   */
  Equilibrium::Evaluation
  balance_in_turns(Equilibrium                                    &problem,
                   const std::vector<TurnParticipant *>           &participants,
                   const std::function<Equilibrium::Evaluation()> &solve,
                   const Equilibrium::Vector                      &u,
                   NewtonReport                                   &report);
} // namespace Morula

#endif
