// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_mechanics_turn_participant_h
#define morula_mechanics_turn_participant_h

#include <morula/mechanics/equilibrium.h>

#include <string>

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
} // namespace Morula

#endif
