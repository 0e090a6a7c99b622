// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/output/output_file.h>

#include <deal.II/base/mpi.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace Morula
{
  using namespace dealii;

  namespace
  {
    using Mode = OutputFile::Mode;

    int
    flags(const Mode mode)
    {
      switch (mode)
        {
          case Mode::append:
            return O_WRONLY | O_CREAT | O_APPEND;
          case Mode::change:
            return O_WRONLY | O_APPEND;
          case Mode::complete:
            return O_WRONLY;
          default:
            return O_WRONLY | O_CREAT | O_TRUNC;
        }
    }

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

  std::string
  temporary_path(const std::string &path)
  {
    return path + ".tmp";
  }

  OutputFile::OutputFile(const std::string &path, const Mode mode)
    : path(path)
    , is_temporary(mode == Mode::replace || mode == Mode::complete)
    , descriptor(
        ::open(is_temporary ? temporary_path(path).c_str() : path.c_str(),
               flags(mode) | O_CLOEXEC,
               0666))
  {
    if (descriptor < 0)
      fail("open");
  }

  OutputFile::~OutputFile()
  {
    if (descriptor >= 0)
      ::close(descriptor);
    if (is_temporary)
      std::remove(temporary_path(path).c_str());
  }

  void
  OutputFile::write(std::string_view text)
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
  OutputFile::reserve(const std::size_t size)
  {
    // Not all file systems can reserve room. On those a full disk shows only
    // later.
    errno = ::posix_fallocate(descriptor, 0, size);
    if (errno != 0 && errno != EOPNOTSUPP && errno != EINVAL)
      fail("write");
  }

  void
  OutputFile::truncate(const std::size_t size)
  {
    if (::ftruncate(descriptor, size) != 0)
      fail("shorten");
  }

  void
  OutputFile::sync()
  {
    // Pipes and some special files cannot be synchronised, which is no error.
    if (::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP)
      fail("write");
  }

  void
  OutputFile::check_in_place() const
  {
    if (!is_open_at(descriptor, path))
      throw std::runtime_error("the file '" + path +
                               "' was deleted or replaced while the run went "
                               "on. Put it back before you resume the run, or "
                               "start the run anew.");
  }

  void
  OutputFile::commit()
  {
    // First the content is on the disk, then the name changes. A file system
    // may report only when it closes the file that it could not write.
    sync();
    if (::close(std::exchange(descriptor, -1)) != 0)
      fail("write");
    if (std::rename(temporary_path(path).c_str(), path.c_str()) != 0)
      fail("replace");
    is_temporary = false;
    sync_directory_of(path);
  }

  void
  OutputFile::fail(const std::string &what) const
  {
    const int reason = errno;
    throw std::runtime_error("cannot " + what + " the file '" + path +
                             "': " + std::strerror(reason));
  }

  void
  write_atomically(const std::string &path, const std::string_view text)
  {
    OutputFile file(path, OutputFile::Mode::replace);
    file.write(text);
    file.commit();
  }


  void
  BackgroundFiles::start(std::function<void()> write, const bool wait)
  {
    finish();
    is_pending = true;
    // std::async is used, as a task of deal.II would run in this thread if
    // deal.II was told to use one. It also keeps what the thread throws.
    if (Utilities::MPI::this_mpi_process(comm) == 0)
      thread = std::async(wait ? std::launch::deferred : std::launch::async,
                          std::move(write));
    if (wait)
      finish();
  }

  bool
  BackgroundFiles::written() const
  {
    // All ranks must get the same answer, as the next step depends on it.
    return is_pending &&
           Utilities::MPI::broadcast(comm,
                                     !thread.valid() ||
                                       thread.wait_for(std::chrono::seconds(
                                         0)) == std::future_status::ready);
  }
} // namespace Morula
