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
  /** Thrown when a signal has asked the run to end and the run has saved its
   *  state. */
  struct StoppedBySignal : std::runtime_error
  {
    /** @param time of the state, day */
    StoppedBySignal(const int signal, const double time);

    int signal;
  };

  /**
   * While this object lives, SIGINT (Ctrl-C), SIGTERM, SIGHUP and SIGUSR1 are
   * recorded and do not end the program. (Batch systems send them before they
   * kill.) A second signal of the same kind ends the program at once. A signal
   * that the program was started to ignore stays ignored. Only one object may
   * live at a time.
   *
   * The environment variable MORULA_LIFELINE = DESCRIPTOR:INODE names a pipe
   * that this process or its parent has open for reading. If nobody has it open
   * for writing any more, the process that began the run is gone, however it
   * ended, and that counts as SIGHUP. So does the end of Open MPI's launcher.
   */
  class StopSignals
  {
  public:
    explicit StopSignals(const MPI_Comm comm);
    ~StopSignals();

    StopSignals(const StopSignals &) = delete;
    StopSignals &
    operator=(const StopSignals &) = delete;

    /** The number of a signal that any rank has received, equal on all ranks;
     *  0 if no rank has received one. Collective. */
    int
    received() const;

  private:
    const MPI_Comm                  comm;
    std::map<int, struct sigaction> actions_before;
  };
} // namespace Morula

#endif
