// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/log.h>

namespace Morula
{
  Log::Log(const std::string &path, const bool resume, const MPI_Comm comm)
    : comm(comm)
  {
    on_root(comm, [&]() {
      file = std::make_unique<OutputFile>(path,
                                         resume ? OutputFile::Mode::append :
                                                  OutputFile::Mode::create);
    });
  }

  void
  Log::write(const std::string &text)
  {
    on_root(comm, [&]() { file->write(text + '\n'); });
  }

  void
  Log::write_if_possible(const std::string &text) noexcept
  {
    try
      {
        if (file)
          file->write(text + '\n');
      }
    catch (const std::exception &)
      {
        // The error that is being reported matters more than this one.
      }
  }
} // namespace Morula
