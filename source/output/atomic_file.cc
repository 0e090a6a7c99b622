// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/atomic_file.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace Morula
{
  namespace
  {
    // Rows are short, and a call of the system for each of them would take
    // longer than the row.
    constexpr std::size_t buffer_size = 1 << 20;

    /**
     * Forces a rename to the disk. Not every file system can do that. Errors
     * do not matter, since the file's content is already on the disk.
     */
    void
    sync_directory_of(const std::string &path)
    {
      const std::string directory =
        std::filesystem::path(path).parent_path().string();
      const int descriptor = ::open(directory.empty() ? "." : directory.c_str(),
                                    O_RDONLY | O_DIRECTORY | O_CLOEXEC);
      if (descriptor >= 0)
        {
          ::fsync(descriptor);
          ::close(descriptor);
        }
    }

    void
    take_name(const std::string &path)
    {
      if (std::rename(temporary_path(path).c_str(), path.c_str()) != 0)
        {
          const int reason = errno;
          // The reason is read before anything else may change errno.
          throw std::runtime_error("cannot replace the file '" + path +
                                   "': " + std::strerror(reason));
        }
      sync_directory_of(path);
    }
  } // namespace

  std::string
  temporary_path(const std::string &path)
  {
    return path + ".tmp";
  }

  void
  publish(const std::string &path)
  {
    // What another library has written under the temporary name is forced to
    // the disk before it takes the file's name: after a crash there is the old
    // file or the new one, never a part.
    PosixFile file(temporary_path(path), PosixFile::Mode::change);
    file.sync();
    file.close();
    take_name(path);
  }

  AtomicFile::AtomicFile(const std::string &path)
    : path(path)
    , file(temporary_path(path), PosixFile::Mode::create)
  {}

  AtomicFile::~AtomicFile()
  {
    // A file that was not committed leaves nothing behind.
    if (!committed)
      std::remove(temporary_path(path).c_str());
  }

  void
  AtomicFile::write(const std::string_view text)
  {
    if (buffer.size() + text.size() < buffer_size)
      {
        buffer += text;
        return;
      }
    // Large pieces are written at once, without a copy in the buffer.
    file.write(buffer);
    buffer.clear();
    file.write(text);
  }

  void
  AtomicFile::commit()
  {
    // First the content is on the disk, then the name changes.
    file.write(buffer);
    file.sync();
    file.close();
    take_name(path);
    committed = true;
  }

  void
  write_atomically(const std::string &path, const std::string_view text)
  {
    AtomicFile file(path);
    file.write(text);
    file.commit();
  }
} // namespace Morula
