// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_shared_file_h
#define morula_output_shared_file_h

#include <morula/output/atomic_file.h>
#include <morula/output/part_of_file.h>

#include <mpi.h>

#include <cstdint>
#include <memory>
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
     * @param shared_from size, bytes, from which on several ranks share a file
     * @return nullptr, on all ranks, if one rank better writes the file:
     * several ranks have less than that, or a file system that cannot do it
     * @throws std::runtime_error on all ranks, with path and reason
     */
    static std::unique_ptr<SharedFile>
    make(const std::string  &path,
         const std::uint64_t n_bytes,
         const MPI_Comm      comm,
         const std::uint64_t shared_from);

    /** See PartOfFile. */
    void
    write(const std::string_view text, const std::uint64_t offset);

    /** Forces this rank's part to the disk. No communication.
     *  @throws std::runtime_error with path and reason */
    void
    close();

    /**
     * Replaces the old file. All ranks must have closed their parts.
     * Collective.
     * @throws std::runtime_error on all ranks, with path and reason
     */
    void
    commit();

  private:
    SharedFile(const std::string  &path,
               const std::uint64_t n_bytes,
               const MPI_Comm      comm);

    const MPI_Comm            comm;
    std::optional<AtomicFile> whole; // on rank 0
    std::optional<PartOfFile> part;
  };
} // namespace Morula

#endif
