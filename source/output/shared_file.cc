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

namespace Morula
{
  using namespace dealii;

  namespace
  {
    /** Of statfs(2): NFS, SMB, CIFS, SMB2, and what runs in user space, such as
     *  sshfs. Their nodes write back whole pages of their own. */
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
  } // namespace

  SharedFile::SharedFile(const std::string  &path,
                         const std::uint64_t n_bytes,
                         const MPI_Comm      comm)
    : comm(comm)
  {
    on_root(comm, [&]() {
      whole.emplace(path);
      whole->reserve(n_bytes);
    });
    const std::string temporary = temporary_path(path);
    bool              usable    = is_coherent(temporary);
    if (usable)
      try
        {
          part.emplace(temporary, PosixFile::Mode::overwrite);
        }
      catch (const std::runtime_error &)
        {
          usable = false; // it is not here
        }
    shared = Utilities::MPI::min(usable ? 1 : 0, comm) == 1;
    if (!shared)
      {
        part.reset();
        whole.reset();
      }
  }

  bool
  SharedFile::is_shared() const
  {
    return shared;
  }

  void
  SharedFile::write(const std::string_view text, const std::uint64_t offset)
  {
    part->write_at(text, offset);
  }

  void
  SharedFile::commit()
  {
    everywhere(comm, [&]() {
      part->sync();
      part->close();
    });
    on_root(comm, [&]() { whole->commit(); });
  }
} // namespace Morula
