// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_output_shared_file_h
#define morula_output_shared_file_h

#include <morula/output/atomic_file.h>
#include <morula/output/background_files.h>

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <memory>
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
    is_shared() const
    {
      return file.has_value();
    }

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
    write(const std::string_view text, const std::uint64_t offset)
    {
      part->write(text, offset);
    }

    /** See PartOfFile. */
    void
    close()
    {
      part->close();
    }

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

  /** What is left to do of a shared file. @param content writes this rank's
   *  part, without communication */
  std::unique_ptr<PendingFile>
  pending(std::unique_ptr<SharedFile>       file,
          std::function<void(SharedFile &)> content);
} // namespace Morula

#endif
