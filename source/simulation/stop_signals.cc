// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/stop_signals.h>

#include <unistd.h>

#include <sstream>
#include <string>
#include <utility>

namespace Morula
{
  namespace
  {
    constexpr std::pair<int, const char *> names[] = {{SIGINT, "SIGINT"},
                                                      {SIGTERM, "SIGTERM"},
                                                      {SIGUSR1, "SIGUSR1"}};

    // A signal handler gets only the number of the signal. It may use only
    // variables of this kind, and none that belongs to an object.
    volatile std::sig_atomic_t last_signal = 0;
    volatile std::sig_atomic_t is_root     = 0;

    extern "C" void
    record_signal(const int number)
    {
      last_signal = number;
      // Streams may be in use when the signal comes, and must not be entered
      // again; write() is safe. One rank tells for all.
      constexpr char text[] =
        "\nmorula: stopping after this step; the same signal again stops at "
        "once, without saving\n";
      if (is_root)
        {
          const auto written = write(STDERR_FILENO, text, sizeof(text) - 1);
          // An error of write() could not be reported.
          static_cast<void>(written);
        }
    }

    std::string
    message(const int signal, const double time)
    {
      std::ostringstream text;
      text << "Stopped at t = " << time << " day by ";
      for (const auto &[number, name] : names)
        if (number == signal)
          text << name;
      text << ". The state is saved in snapshot.h5.";
      return text.str();
    }
  } // namespace

  StoppedBySignal::StoppedBySignal(const int signal, const double time)
    : std::runtime_error(message(signal, time))
    , signal(signal)
  {}

  StopSignals::StopSignals(const MPI_Comm comm)
    : comm(comm)
  {
    // SA_RESETHAND restores the default after the first signal, so that the
    // second one ends the program. SA_RESTART lets the calls of files and
    // messages go on that a signal has interrupted. What was set before is kept
    // for the destructor.
    last_signal = 0;
    is_root     = dealii::Utilities::MPI::this_mpi_process(comm) == 0;
    struct sigaction action{};
    action.sa_handler = record_signal;
    action.sa_flags   = SA_RESETHAND | SA_RESTART;
    for (const auto &[number, name] : names)
      {
        struct sigaction before{};
        sigaction(number, nullptr, &before);
        // A program that runs under nohup, say, is to go on.
        if (before.sa_handler == SIG_IGN)
          continue;
        sigaction(number, &action, nullptr);
        actions_before[number] = before;
      }
  }

  StopSignals::~StopSignals()
  {
    for (const auto &[number, before] : actions_before)
      sigaction(number, &before, nullptr);
  }

  int
  StopSignals::received() const
  {
    // A launcher may send the signal to some ranks only, or to all at different
    // times. All stop after the same step.
    return dealii::Utilities::MPI::max(static_cast<int>(last_signal), comm);
  }
} // namespace Morula
