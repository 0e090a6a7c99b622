// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/pending_file.h>

#include <utility>

namespace Morula
{
  PendingFile::PendingFile(std::unique_ptr<SharedFile>       file,
                           std::function<void(SharedFile &)> content)
    : file(std::move(file))
    , content(std::move(content))
  {}

  void
  PendingFile::write()
  {
    content(*file);
    content = nullptr;
    file->close();
  }

  void
  PendingFile::commit()
  {
    file->commit();
  }

  void
  finish(std::unique_ptr<PendingFile> file, const MPI_Comm comm)
  {
    if (file == nullptr)
      return;
    everywhere(comm, [&]() { file->write(); });
    file->commit();
  }
} // namespace Morula
