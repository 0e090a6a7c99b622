// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/part_of_file.h>

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

  bool
  PartOfFile::is_shared() const
  {
    return file.has_value();
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
} // namespace Morula
