// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/input_error.h>
#include <morula/output/directory.h>
#include <morula/output/output_file.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <thread>

namespace Morula
{
  using namespace dealii;

  namespace
  {
    // There are several attempts, as another process may hold the file for a
    // moment only to look at it, or may not have written its name yet.
    constexpr unsigned int              n_attempts = 20;
    constexpr std::chrono::milliseconds pause(10);

    std::string
    lock_file(const std::string &directory)
    {
      return directory + "/morula.lock";
    }

    /** What the run that holds the lock has written, as printable characters.
     */
    std::string
    holder(const std::string &path)
    {
      std::ifstream in(path);
      std::string   line;
      std::getline(in, line);
      // The file may be anybody's, so its text is cut and made printable.
      line.resize(std::min<std::size_t>(line.size(), 200));
      for (char &c : line)
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f')
          c = '?';
      return line.empty() ? "a process that has not said its name" : line;
    }

    /** Throws an InputError with the system's reason. */
    [[noreturn]] void
    refuse_to_write(const std::string &directory)
    {
      throw InputError("Output directory",
                       directory,
                       std::string("a directory in which 'morula.lock' can be "
                                   "written (") +
                         std::strerror(errno) + ")",
                       "Choose another one, or change its permissions.");
    }

    bool
    sign(const int descriptor)
    {
      const std::string name = "process " + std::to_string(::getpid()) +
                               " on " + Utilities::System::get_hostname() +
                               '\n';
      // The name of an earlier holder may be longer.
      return ::ftruncate(descriptor, 0) == 0 &&
             ::pwrite(descriptor, name.data(), name.size(), 0) > 0;
    }

    [[noreturn]] void
    refuse(const std::string &directory)
    {
      throw InputError("Output directory",
                       directory,
                       "a directory in which no other run is at work (there is "
                       "one: " +
                         holder(lock_file(directory)) + ")",
                       "Wait for its end, or stop it there: after 'kill -USR1' "
                       "it saves its state. Or choose another directory.");
    }
  } // namespace

  DirectoryLock::DirectoryLock(const std::string &directory,
                               const MPI_Comm     comm)
    : path(lock_file(directory))
  {
    on_root(comm, [&]() {
      create_directory(directory);
      take(directory);
    });
    reason_without_lock_ =
      Utilities::MPI::broadcast(comm, reason_without_lock_);
  }

  void
  DirectoryLock::take(const std::string &directory)
  {
    // A lock on a file that the directory no longer has is worth nothing: the
    // holder before may have deleted it between open() and flock(). So a lock
    // counts only if the file is still the one of that name; else another one
    // is made and tried. A lock that somebody holds is tried again for a
    // moment. On a file system without locks the run goes on, and the log says
    // so.
    for (unsigned int attempt = 0; attempt < n_attempts; ++attempt)
      {
        descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor < 0)
          refuse_to_write(directory);
        const bool locked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
        const int  reason = errno;
        // The holder before may have removed the file meanwhile.
        if (locked && is_open_at(descriptor, path))
          {
            if (!sign(descriptor))
              refuse_to_write(directory);
            return;
          }
        ::close(std::exchange(descriptor, -1));
        if (locked)
          continue;
        if (reason != EWOULDBLOCK)
          {
            reason_without_lock_ =
              std::string("This file system knows no locks (") +
              std::strerror(reason) + "): nothing keeps another run out of '" +
              directory + "'.";
            std::remove(path.c_str());
            return;
          }
        std::this_thread::sleep_for(pause);
      }
    refuse(directory);
  }

  DirectoryLock::~DirectoryLock()
  {
    if (descriptor < 0)
      return;
    // The file goes before the lock does: until then nobody else can take it.
    if (is_open_at(descriptor, path))
      std::remove(path.c_str());
    ::close(descriptor);
  }

  void
  DirectoryLock::check_free(const std::string &directory)
  {
    const int descriptor =
      ::open(lock_file(directory).c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
      return;
    const bool held =
      // A shared lock only looks: it disturbs nobody for longer than this call.
      ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    ::close(descriptor);
    if (held)
      refuse(directory);
  }
} // namespace Morula
