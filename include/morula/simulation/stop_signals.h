// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_simulation_stop_signals_h
#define morula_simulation_stop_signals_h

#include <deal.II/base/mpi.h>

#include <csignal>
#include <map>
#include <stdexcept>

namespace Morula
{
  /** A run that a signal has asked to end, and that has saved its state. */
  struct RunStopped : std::runtime_error
  {
    /** @param time of the state, day */
    RunStopped(const int signal, const double time);

    int signal;
  };

  /**
   * While this object lives, SIGINT (Ctrl-C), SIGTERM and SIGUSR1 (as batch
   * systems send them before they kill) are taken down instead of ending the
   * program. The same signal once more ends it at once. Signals that the
   * program was started to ignore stay ignored. One object at a time.
   */
  class StopSignals
  {
  public:
    explicit StopSignals(const MPI_Comm comm);
    ~StopSignals();

    StopSignals(const StopSignals &) = delete;
    StopSignals &
    operator=(const StopSignals &) = delete;

    /** The number of a signal that came to any rank, the same on all of them;
     *  0 if none has. Collective. */
    int
    received() const;

  private:
    const MPI_Comm                  comm;
    std::map<int, struct sigaction> actions_before;
  };
} // namespace Morula

#endif
