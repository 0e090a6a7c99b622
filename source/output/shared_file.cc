// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/shared_file.h>

#include <deal.II/base/mpi.h>

#include <sys/vfs.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace Morula
{
  using namespace dealii;

  namespace
  {
    /** File systems by their number in statfs(2): NFS, SMB, CIFS, SMB2, and
     *  what runs in user space, such as sshfs. Their nodes write back whole
     *  pages of their own, so that two nodes may destroy each other's parts. */
    constexpr unsigned long incoherent[] = {
      0x6969, 0x517b, 0xff534d42, 0xfe534d42, 0x65735546};

    bool
    is_coherent(const std::string &path)
    {
      struct statfs found{};
      return ::statfs(path.c_str(), &found) == 0 &&
             std::find(std::begin(incoherent),
                       std::end(incoherent),
                       found.f_type & 0xffffffffu) == std::end(incoherent);
    }

    /** Another node may have a file of that name on a disk of its own, which
     *  has another size. */
    bool
    has_size(const std::string &path, const std::uint64_t n_bytes)
    {
      std::error_code error;
      return std::filesystem::file_size(path, error) == n_bytes && !error;
    }
  } // namespace

  PartOfFile::PartOfFile(const std::string  &path,
                         const std::uint64_t n_bytes,
                         const MPI_Comm      comm)
  {
    // One rank alone can always write. Several can if each sees the same file
    // on a file system that keeps what several nodes write. All use their
    // parts, or none does: the last line makes that one decision for all.
    bool usable = Utilities::MPI::n_mpi_processes(comm) == 1 ||
                  (is_coherent(path) && has_size(path, n_bytes));
    if (usable)
      try
        {
          file.emplace(path, PosixFile::Mode::overwrite);
        }
      catch (const std::runtime_error &)
        {
          usable = false;
        }
    if (Utilities::MPI::min(usable ? 1 : 0, comm) == 0)
      file.reset();
  }

  void
  PartOfFile::write(const std::string_view text, const std::uint64_t offset)
  {
    file->write_at(text, offset);
  }

  void
  PartOfFile::close()
  {
    file->sync();
    file->close();
  }

  std::unique_ptr<SharedFile>
  SharedFile::make(const std::string  &path,
                   const std::uint64_t n_bytes,
                   const MPI_Comm      comm,
                   const std::uint64_t shared_from)
  {
    // Rank 0 alone writes short files.
    if (Utilities::MPI::n_mpi_processes(comm) > 1 && n_bytes < shared_from)
      return nullptr;
    std::unique_ptr<SharedFile> file(new SharedFile(path, n_bytes, comm));
    return file->part->is_shared() ? std::move(file) : nullptr;
  }

  SharedFile::SharedFile(const std::string  &path,
                         const std::uint64_t n_bytes,
                         const MPI_Comm      comm)
    : comm(comm)
  {
    // Rank 0 makes the file with its full size, so that a full disk shows
    // before anything is written. Then all ranks open it.
    on_root(comm, [&]() {
      whole.emplace(path);
      whole->reserve(n_bytes);
    });
    part.emplace(temporary_path(path), n_bytes, comm);
  }

  void
  SharedFile::commit()
  {
    on_root(comm, [&]() { whole->commit(); });
  }

  std::unique_ptr<PendingFile>
  pending(std::unique_ptr<SharedFile>       file,
          std::function<void(SharedFile &)> content)
  {
    // The functions of a pending file may be copied, so they share the file.
    const std::shared_ptr<SharedFile> shared = std::move(file);
    return std::make_unique<PendingFile>(
      PendingFile{[shared, content = std::move(content)]() {
                    content(*shared);
                    shared->close();
                  },
                  [shared]() { shared->commit(); },
                  {}});
  }
} // namespace Morula
