// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/program/ranks.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <initializer_list>
#include <iostream>
#include <set>
#include <thread>

namespace Morula
{
  namespace
  {
    /** Whether mpiexec or a batch system has started this process. */
    bool
    is_launched()
    {
      const std::initializer_list<const char *> variables = {
        "OMPI_COMM_WORLD_SIZE",
        "PMIX_RANK",
        "PMI_RANK",
        "PMI_FD",
        "SLURM_PROCID"};
      return std::any_of(variables.begin(),
                         variables.end(),
                         [](const char *variable) {
                           return std::getenv(variable) != nullptr;
                         });
    }

    /** How long failed ranks wait for the others. */
    constexpr std::chrono::seconds waiting_time(5);

    /**
     * Whether all ranks arrive here in time. A nonblocking barrier never
     * matches the operations in which the other ranks may be waiting.
     */
    bool
    all_arrive(const MPI_Comm comm)
    {
      // MPI has no barrier with a limit of time, so the rank looks again each
      // millisecond. The request of a barrier that is never reached is left
      // open, as the program is aborted then.
      MPI_Request request;
      MPI_Ibarrier(comm, &request);
      const auto end     = std::chrono::steady_clock::now() + waiting_time;
      int        arrived = 0;
      while (true)
        {
          MPI_Test(&request, &arrived, MPI_STATUS_IGNORE);
          if (arrived || std::chrono::steady_clock::now() > end)
            return arrived;
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }

    /** Longest message, bytes; longer ones lose their middle. A message repeats
     *  what the user wrote, which may be long, and its end says what to do. */
    constexpr std::size_t longest_message = 2500;

    void
    print(std::string message)
    {
      if (message.size() > longest_message)
        message = message.substr(0, longest_message / 2) + " [...] " +
                  message.substr(message.size() - longest_message / 2);
      // The message is written in one piece, so that the lines of ranks do not
      // mix.
      std::cerr << "morula: " + message + "\n" << std::flush;
    }
  } // namespace


  void
  set_up_open_mpi()
  {
    // The number of a component is that of the ROMIO which the version of Open
    // MPI contains; a name that it does not know is ignored. The last argument
    // 0 leaves what the user has set.
    for (const char *variable :
         {"OMPI_MCA_io_romio321_priority", "OMPI_MCA_io_romio341_priority"})
      setenv(variable, "100", 0);
    setenv("HWLOC_COMPONENTS", "-gl", 0);
    // What follows is for one rank that starts itself. Ranks of a launcher need
    // the daemon and the directories to find each other.
    if (is_launched())
      return;
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
    setenv("OMPI_MCA_orte_create_session_dirs", "0", 0);
    setenv("OMPI_MCA_pml", "ob1", 0);
  }


  int
  end_all_ranks(const int          exit_code,
                const std::string &message,
                const MPI_Comm     comm)
  {
    // The barrier tells whether every rank has failed. Only then is it safe to
    // gather the messages and to return: a rank that still works would wait in
    // its next collective call for ever, so it is aborted instead. The largest
    // exit code counts, as 1 promises that nothing was computed.
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(comm);
    if (!all_arrive(comm))
      {
        print("(rank " + std::to_string(rank) + ") " + message);
        MPI_Abort(comm, exit_code);
      }

    // A rank that fails because another one did has another message, so all
    // different ones are printed.
    std::set<std::string> printed;
    for (const std::string &each :
         dealii::Utilities::MPI::gather(comm, message))
      if (printed.insert(each).second)
        print(each);
    return dealii::Utilities::MPI::max(exit_code, comm);
  }
} // namespace Morula
