// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/base/input_error.h>
#include <morula/base/step_failed.h>

#include <deal.II/base/mpi.h>

#include <string>

namespace Morula
{
  using namespace dealii;

  namespace
  {
    /** What an action has thrown. */
    enum class Thrown
    {
      nothing,
      input_error,
      step_failed,
      other
    };
  } // namespace


  void
  everywhere(const MPI_Comm comm, const std::function<void()> &action)
  {
    // Each rank runs the action and keeps what it throws. One reduction tells
    // all of them whether any has failed, so that all go on or all throw;
    // without it the others would wait for ever in their next collective call.
    // The error of the lowest rank counts, and travels as kind and text. Kinds
    // that callers tell apart are thrown as such, all others as a
    // runtime_error.
    const unsigned int n_ranks = Utilities::MPI::n_mpi_processes(comm);
    const unsigned int rank    = Utilities::MPI::this_mpi_process(comm);

    Thrown      thrown = Thrown::nothing;
    std::string message;
    try
      {
        action();
      }
    catch (const InputError &error)
      {
        thrown  = Thrown::input_error;
        message = error.what();
      }
    catch (const StepFailed &failure)
      {
        thrown  = Thrown::step_failed;
        message = failure.what();
      }
    catch (const std::exception &error)
      {
        thrown  = Thrown::other;
        message = error.what();
      }

    const unsigned int first =
      // n_ranks stands for no rank at all.
      Utilities::MPI::min(thrown == Thrown::nothing ? n_ranks : rank, comm);
    if (first == n_ranks)
      return;

    message = Utilities::MPI::broadcast(comm, message, first);
    thrown  = Utilities::MPI::broadcast(comm, thrown, first);
    if (thrown == Thrown::input_error)
      throw InputError(message);
    if (thrown == Thrown::step_failed)
      throw StepFailed(message);
    throw std::runtime_error(message);
  }

  void
  on_root(const MPI_Comm comm, const std::function<void()> &action)
  {
    // The other ranks have nothing to do, but learn whether rank 0 has failed.
    everywhere(comm, [&]() {
      if (Utilities::MPI::this_mpi_process(comm) == 0)
        action();
    });
  }


  std::pair<std::uint64_t, std::uint64_t>
  share(const std::uint64_t n, const MPI_Comm comm)
  {
    const std::uint64_t rank = dealii::Utilities::MPI::this_mpi_process(comm);
    const std::uint64_t n_ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
    // n % n_ranks * r / n_ranks spreads the rest evenly, and no product
    // overflows.
    const auto begin = [=](const std::uint64_t r) {
      return n / n_ranks * r + n % n_ranks * r / n_ranks;
    };
    return {begin(rank), begin(rank + 1)};
  }
} // namespace Morula
