// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_solver_turns_h
#define morula_solver_turns_h

#include <morula/mechanics/turn_participant.h>
#include <morula/solver/newton.h>

#include <functional>
#include <vector>

namespace Morula
{
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
