// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_pending_file_h
#define morula_output_pending_file_h

#include <morula/output/shared_file.h>

#include <mpi.h>

#include <functional>
#include <memory>

namespace Morula
{
  /** A file whose room is there, and whose content can be written without
   *  messages: so another thread can do that. */
  class PendingFile
  {
  public:
    /** @param content writes this rank's part */
    PendingFile(std::unique_ptr<SharedFile>       file,
                std::function<void(SharedFile &)> content);

    /** Writes this rank's part to the disk, and forgets where it is from. No
     *  communication.
     *  @throws std::runtime_error with path and reason */
    void
    write();

    /** Replaces the old file, when all ranks have written. Collective.
     *  @throws std::runtime_error on all ranks, with path and reason */
    void
    commit();

  private:
    std::unique_ptr<SharedFile>       file;
    std::function<void(SharedFile &)> content;
  };
} // namespace Morula

#endif
