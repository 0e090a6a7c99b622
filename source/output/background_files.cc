// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/background_files.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace Morula
{
  using namespace dealii;

  BackgroundFiles::BackgroundFiles(const MPI_Comm comm)
    : comm(comm)
  {}

  void
  BackgroundFiles::start(std::vector<std::unique_ptr<PendingFile>> new_files,
                         const bool                                wait)
  {
    // Only one group of files is written at a time: the one before must be
    // complete.
    finish();
    files = std::move(new_files);
    // Files that were written at once, and not shared, are null here.
    files.erase(std::remove(files.begin(), files.end(), nullptr), files.end());
    if (files.empty())
      return;
    // std::async is used, as a task of deal.II would run in this thread if
    // deal.II was told to use one. It also keeps what the thread throws.
    const auto write = [this]() {
      for (const auto &file : files)
        file->write();
    };
    thread =
      std::async(wait ? std::launch::deferred : std::launch::async, write);
    if (wait)
      finish();
  }

  bool
  BackgroundFiles::pending() const
  {
    return !files.empty();
  }

  bool
  BackgroundFiles::written() const
  {
    if (!pending())
      return false;
    // A rank asks its own thread. All ranks must get the same answer, as the
    // next step depends on it.
    const bool mine =
      thread.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    return Utilities::MPI::min(mine ? 1 : 0, comm) == 1;
  }

  void
  BackgroundFiles::finish()
  {
    if (!pending())
      return;
    try
      {
        // An error of any rank's thread is thrown on all ranks; then no file
        // takes the place of an old one.
        everywhere(comm, [this]() { thread.get(); });
      }
    catch (...)
      {
        files.clear();
        throw;
      }
    // All ranks have written their parts, so the files are whole.
    for (const auto &file : std::exchange(files, {}))
      file->commit();
  }
} // namespace Morula
