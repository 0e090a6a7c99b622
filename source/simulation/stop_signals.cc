// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/simulation/stop_signals.h>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>

namespace Morula
{
  namespace
  {
    constexpr std::pair<int, const char *> names[] = {{SIGINT, "SIGINT"},
                                                      {SIGTERM, "SIGTERM"},
                                                      {SIGHUP, "SIGHUP"},
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
        "\nmorula: saving the state; the same signal again stops at once, "
        "without saving\n";
      if (is_root)
        {
          const auto written = write(STDERR_FILENO, text, sizeof(text) - 1);
          // An error of write() could not be reported.
          static_cast<void>(written);
        }
    }

    /** The reading end of the pipe that MORULA_LIFELINE names, or -1. */
    int lifeline = -1;
    /** Open MPI's process that has started this rank, or 0. A second SIGTERM,
     *  such as timeout sends, ends it without a word to its ranks, and they
     *  end a second later. */
    pid_t launcher = 0;

    int
    open_lifeline()
    {
      // mpiexec closes what its ranks would inherit, but has it open itself, so
      // the parent is looked at, too. Only the pipe's inode tells it from
      // another file with the same number.
      const char *const  text = std::getenv("MORULA_LIFELINE");
      int                descriptor;
      unsigned long long inode;
      if (text == nullptr ||
          std::sscanf(text, "%d:%llu", &descriptor, &inode) != 2)
        return -1;
      for (const pid_t process : {getpid(), getppid()})
        {
          const std::string path = "/proc/" + std::to_string(process) + "/fd/" +
                                   std::to_string(descriptor);
          struct stat about{};
          if (stat(path.c_str(), &about) == 0 && S_ISFIFO(about.st_mode) &&
              about.st_ino == inode)
            return open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
        }
      return -1;
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
    lifeline    = open_lifeline();
    launcher = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr ? getppid() : 0;
    is_root  = dealii::Utilities::MPI::this_mpi_process(comm) == 0;
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
    if (lifeline >= 0)
      close(lifeline);
  }

  int
  StopSignals::received() const
  {
    // A launcher may send the signal to some ranks only, or to all at different
    // times. All stop after the same step. No descriptor (-1) is never ready.
    pollfd     watched{lifeline, 0, 0};
    const bool is_orphan =
      (launcher != 0 && getppid() != launcher) ||
      (poll(&watched, 1, 0) > 0 && (watched.revents & POLLHUP) != 0);
    const int signal = last_signal == 0 && is_orphan ? SIGHUP : last_signal;
    return dealii::Utilities::MPI::max(signal, comm);
  }
} // namespace Morula
