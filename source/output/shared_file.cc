// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/agreement.h>
#include <morula/output/shared_file.h>

namespace Morula
{
  SharedFile::SharedFile(const std::string  &path,
                         const std::uint64_t n_bytes,
                         const MPI_Comm      comm)
    : comm(comm)
  {
    on_root(comm, [&]() {
      whole.emplace(path);
      whole->reserve(n_bytes);
    });
    part.emplace(temporary_path(path), n_bytes, comm);
    if (!part->is_shared())
      whole.reset();
  }

  bool
  SharedFile::is_shared() const
  {
    return part->is_shared();
  }

  void
  SharedFile::write(const std::string_view text, const std::uint64_t offset)
  {
    part->write(text, offset);
  }

  void
  SharedFile::commit()
  {
    part->finish();
    on_root(comm, [&]() { whole->commit(); });
  }
} // namespace Morula
