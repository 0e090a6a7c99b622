// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>

#include <deal.II/base/mpi.h>

#include <string>

namespace Morula
{
  using namespace dealii;

  void
  everywhere(const MPI_Comm comm, const std::function<void()> &action)
  {
    const unsigned int n_ranks = Utilities::MPI::n_mpi_processes(comm);
    const unsigned int rank    = Utilities::MPI::this_mpi_process(comm);

    bool        failed   = false;
    bool        by_input = false;
    std::string message;
    try
      {
        action();
      }
    catch (const InputError &error)
      {
        failed   = true;
        by_input = true;
        message  = error.what();
      }
    catch (const std::exception &error)
      {
        failed  = true;
        message = error.what();
      }

    const unsigned int first =
      Utilities::MPI::min(failed ? rank : n_ranks, comm);
    if (first == n_ranks)
      return;

    message  = Utilities::MPI::broadcast(comm, message, first);
    by_input = Utilities::MPI::broadcast(comm, by_input, first);
    if (by_input)
      throw InputError(message);
    throw std::runtime_error(message);
  }

  void
  on_root(const MPI_Comm comm, const std::function<void()> &action)
  {
    everywhere(comm, [&]() {
      if (Utilities::MPI::this_mpi_process(comm) == 0)
        action();
    });
  }
} // namespace Morula
