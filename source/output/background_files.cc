// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/background_files.h>

#include <deal.II/base/mpi.h>

#include <chrono>
#include <utility>

namespace Morula
{
  using namespace dealii;

  BackgroundFiles::BackgroundFiles(const MPI_Comm comm)
    : comm(comm)
  {}

  void
  BackgroundFiles::start(std::function<void()> write, const bool wait)
  {
    finish();
    is_pending = true;
    // std::async is used, as a task of deal.II would run in this thread if
    // deal.II was told to use one. It also keeps what the thread throws.
    if (Utilities::MPI::this_mpi_process(comm) == 0)
      thread = std::async(wait ? std::launch::deferred : std::launch::async,
                          std::move(write));
    if (wait)
      finish();
  }

  bool
  BackgroundFiles::written() const
  {
    // All ranks must get the same answer, as the next step depends on it.
    return is_pending &&
           Utilities::MPI::broadcast(comm,
                                     !thread.valid() ||
                                       thread.wait_for(std::chrono::seconds(
                                         0)) == std::future_status::ready);
  }

  void
  BackgroundFiles::finish()
  {
    if (std::exchange(is_pending, false))
      on_root(comm, [this]() { thread.get(); });
  }
} // namespace Morula
