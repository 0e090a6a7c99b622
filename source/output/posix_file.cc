// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/posix_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace Morula
{
  namespace
  {
    int
    flags(const PosixFile::Mode mode)
    {
      switch (mode)
        {
          case PosixFile::Mode::create:
            return O_WRONLY | O_CREAT | O_TRUNC;
          case PosixFile::Mode::append:
            return O_WRONLY | O_CREAT | O_APPEND;
          case PosixFile::Mode::overwrite:
            return O_WRONLY;
          default:
            return O_WRONLY | O_APPEND;
        }
    }
  } // namespace

  bool
  is_open_at(const int descriptor, const std::string &path)
  {
    // A file with the same device and the same number is the same one, whatever
    // its name.
    struct stat opened{}, there{};
    return ::fstat(descriptor, &opened) == 0 &&
           ::stat(path.c_str(), &there) == 0 && opened.st_dev == there.st_dev &&
           opened.st_ino == there.st_ino;
  }

  PosixFile::PosixFile(const std::string &path, const Mode mode)
    : path(path)
    , descriptor(::open(path.c_str(), flags(mode) | O_CLOEXEC, 0666))
  {
    if (descriptor < 0)
      fail("open");
  }

  PosixFile::~PosixFile()
  {
    if (descriptor >= 0)
      ::close(descriptor);
  }

  void
  PosixFile::write(std::string_view text)
  {
    while (!text.empty())
      {
        // A call may write less than it was given, and may be interrupted by a
        // signal.
        const ssize_t n = ::write(descriptor, text.data(), text.size());
        if (n >= 0)
          text.remove_prefix(n);
        else if (errno != EINTR)
          fail("write");
      }
  }

  void
  PosixFile::write_at(std::string_view text, std::uint64_t offset)
  {
    while (!text.empty())
      {
        const ssize_t n =
          ::pwrite(descriptor, text.data(), text.size(), offset);
        if (n >= 0)
          {
            text.remove_prefix(n);
            offset += n;
          }
        else if (errno != EINTR)
          fail("write");
      }
  }

  void
  PosixFile::reserve(const std::size_t size)
  {
    // Not all file systems can reserve room. On those a full disk shows only
    // later.
    errno = ::posix_fallocate(descriptor, 0, size);
    if (errno != 0 && errno != EOPNOTSUPP && errno != EINVAL)
      fail("write");
  }

  void
  PosixFile::truncate(const std::size_t size)
  {
    if (::ftruncate(descriptor, size) != 0)
      fail("shorten");
  }

  void
  PosixFile::sync()
  {
    // Pipes and some special files cannot be synchronised, which is no error.
    if (::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP)
      fail("write");
  }

  void
  PosixFile::check_in_place() const
  {
    if (!is_open_at(descriptor, path))
      throw std::runtime_error("the file '" + path +
                               "' was deleted or replaced while the run went "
                               "on. Put it back before you resume the run, or "
                               "start the run anew.");
  }

  void
  PosixFile::close()
  {
    // A file system may report only now that it could not write.
    if (::close(std::exchange(descriptor, -1)) != 0)
      fail("write");
  }

  void
  PosixFile::fail(const std::string &what) const
  {
    const int reason = errno;
    throw std::runtime_error("cannot " + what + " the file '" + path +
                             "': " + std::strerror(reason));
  }
} // namespace Morula
