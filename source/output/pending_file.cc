// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

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
    // The content may hold much memory, and is not needed any more.
    content = nullptr;
    file->close();
  }

  void
  PendingFile::commit()
  {
    file->commit();
  }
} // namespace Morula
