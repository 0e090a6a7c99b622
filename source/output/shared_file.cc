// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/shared_file.h>

#include <deal.II/base/mpi.h>

namespace Morula
{
  using namespace dealii;

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
  SharedFile::write(const std::string_view text, const std::uint64_t offset)
  {
    part->write(text, offset);
  }

  void
  SharedFile::close()
  {
    part->close();
  }

  void
  SharedFile::commit()
  {
    on_root(comm, [&]() { whole->commit(); });
  }
} // namespace Morula
