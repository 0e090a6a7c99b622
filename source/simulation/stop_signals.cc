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

    // A signal handler gets only the number, and may use only such variables.
    volatile std::sig_atomic_t last_signal = 0;
    volatile std::sig_atomic_t is_root     = 0;

    extern "C" void
    record_signal(const int number)
    {
      last_signal = number;
      constexpr char text[] =
        "\nmorula: stopping after this step; the same signal again stops at "
        "once, without saving\n";
      if (is_root)
        {
          const auto written = write(STDERR_FILENO, text, sizeof(text) - 1);
          static_cast<void>(written); // an error could not be reported
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
    last_signal = 0;
    is_root     = dealii::Utilities::MPI::this_mpi_process(comm) == 0;
    struct sigaction action{};
    action.sa_handler = record_signal;
    action.sa_flags   = SA_RESETHAND | SA_RESTART;
    for (const auto &[number, name] : names)
      {
        struct sigaction before{};
        sigaction(number, nullptr, &before);
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
    return dealii::Utilities::MPI::max(static_cast<int>(last_signal), comm);
  }
} // namespace Morula
