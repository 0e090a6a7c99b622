// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_part_of_file_h
#define morula_output_part_of_file_h

#include <morula/output/posix_file.h>

#include <mpi.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace Morula
{
  /**
   * A file of rank 0 that all ranks write, each its parts at their places,
   * through a descriptor of its own. MPI's own files are not used: when the
   * disk is full, these fail on some ranks only, and the others wait for them
   * for ever.
   */
  class PartOfFile
  {
  public:
    /** Less is written faster by one rank: bytes. */
    static constexpr std::uint64_t worth_while = 10000000;

    /** @param n_bytes the size that rank 0 has given the file. Collective. */
    PartOfFile(const std::string  &path,
               const std::uint64_t n_bytes,
               const MPI_Comm      comm);

    /** Whether all ranks see the file, on a file system that keeps what several
     *  write into it. (NFS does not; disks of single nodes are not seen.) Equal
     *  on all ranks, and true on one. Where this is false, nothing is to be
     *  written. */
    bool
    is_shared() const;

    /** Writes a part of this rank. No communication.
     *  @throws std::runtime_error with path and reason */
    void
    write(const std::string_view text, const std::uint64_t offset);

    /** Forces this rank's parts to the disk, and closes its descriptor. No
     *  communication.
     *  @throws std::runtime_error with path and reason */
    void
    close();

  private:
    std::optional<PosixFile> file; // if it is shared
  };
} // namespace Morula

#endif
