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
    launch(wait ? std::launch::deferred : std::launch::async);
    if (wait)
      finish();
  }

  void
  BackgroundFiles::launch(const std::launch policy)
  {
    // std::async is used, as a task of deal.II would run in this thread if
    // deal.II was told to use one. It also keeps what the thread throws. What
    // has been written is forgotten at once, as it may hold much memory.
    thread = std::async(policy, [this]() {
      for (const auto &file : files)
        if (const auto write = std::exchange(file->write, nullptr))
          write();
    });
  }

  bool
  BackgroundFiles::end_stage()
  {
    try
      {
        // An error of any rank's thread is thrown on all ranks; then no file
        // takes the place of an old one.
        everywhere(comm, [this]() { thread.get(); });
        bool more = false;
        for (auto &file : files)
          if (file->next)
            {
              file = file->next();
              more = true;
            }
        if (more)
          launch(std::launch::async);
        return more;
      }
    catch (...)
      {
        files.clear();
        throw;
      }
  }

  bool
  BackgroundFiles::written()
  {
    if (!pending())
      return false;
    // A rank asks its own thread. All ranks must get the same answer, as the
    // next step depends on it.
    const bool mine =
      !thread.valid() ||
      thread.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    return Utilities::MPI::min(mine ? 1 : 0, comm) == 1 &&
           (!thread.valid() || !end_stage());
  }

  void
  BackgroundFiles::finish()
  {
    while (thread.valid() && end_stage()) {}
    // All ranks have written their parts, so the files are whole.
    for (const auto &file : std::exchange(files, {}))
      file->commit();
  }
} // namespace Morula
