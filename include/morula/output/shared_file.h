// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_shared_file_h
#define morula_output_shared_file_h

#include <morula/output/atomic_file.h>
#include <morula/output/part_of_file.h>

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace Morula
{
  /**
   * A file of known size that all ranks write together (see PartOfFile). It
   * replaces the old one of its name when it is complete (see AtomicFile).
   */
  class SharedFile
  {
  public:
    /**
     * Makes the file, and reserves its room on the disk. Collective.
     * @throws std::runtime_error on all ranks, with path and reason
     */
    SharedFile(const std::string  &path,
               const std::uint64_t n_bytes,
               const MPI_Comm      comm);

    /** See PartOfFile. */
    bool
    is_shared() const;

    /** See PartOfFile. */
    void
    write(const std::string_view text, const std::uint64_t offset);

    /**
     * Forces all parts to the disk, and replaces the old file. Collective.
     * @throws std::runtime_error on all ranks, with path and reason
     */
    void
    commit();

  private:
    const MPI_Comm            comm;
    std::optional<AtomicFile> whole; // on rank 0
    std::optional<PartOfFile> part;
  };
} // namespace Morula

#endif
