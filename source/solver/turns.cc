// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/solver/turns.h>

namespace Morula
{
  namespace
  {
    /** A volume that is kept takes two to four turns, a held traction as many:
     *  what needs more does not contract. */
    constexpr unsigned int most_turns = 20;
  } // namespace


  Equilibrium::Evaluation
  balance_in_turns(Equilibrium                                    &problem,
                   const std::vector<TurnParticipant *>           &participants,
                   const std::function<Equilibrium::Evaluation()> &solve,
                   const Equilibrium::Vector                      &u,
                   NewtonReport                                   &report)
  {
    // Each turn finds an equilibrium with what the participants hold fixed, and
    // then has all of them renew it, doc/theory.md (5.6). All are asked, also
    // after one has said that it needs another turn: their quantities belong to
    // the same u. After the first turn the tissue has the new growth, and so
    // have all further tangents.
    for (report.place.turn = 1;; ++report.place.turn)
      {
        ++report.turns;
        const Equilibrium::Evaluation evaluation = solve();
        std::string                   unfinished;
        for (TurnParticipant *const participant : participants)
          if (participant->renew(u) && unfinished.empty())
            unfinished = participant->unfinished();
        if (unfinished.empty())
          return evaluation;
        if (report.place.turn == most_turns)
          throw StepFailed(unfinished);
        problem.use_growth_at_end();
      }
  }
} // namespace Morula
